#include "capstan/recording/recording_keys.h"

#include <array>
#include <nlohmann/json.hpp>

#include "capstan/rig/channel_names.h"

namespace capstan {

namespace {

using nlohmann::ordered_json;

constexpr unsigned bit(BenchMode mode) {
    return 1u << static_cast<unsigned>(mode);
}
constexpr unsigned every = 15;
constexpr unsigned pair = bit(BenchMode::pull_pull);
constexpr unsigned with_geometry = pair | bit(BenchMode::single_cable);

// A number, or a range of two.
constexpr const char* range = "number or [low, high]";

struct NamedMode {
    BenchMode mode;
    std::string_view name;
};
constexpr std::array modes = {
    NamedMode{BenchMode::pull_pull, "pull_pull"}, NamedMode{BenchMode::single_cable, "single_cable"},
    NamedMode{BenchMode::lumped_drive, "lumped_drive"}, NamedMode{BenchMode::capstan_band, "capstan_band"}};

const std::vector<RecordingKey> keys = {
    {"", "case", "string", "", "Name of the recording.", "the file's name", "\"bench 3\"", every},
    {"", "schema", "number", "", "Version of this format.", "1", "1", every},
    {"", "mode", "string", "",
     "The kind of bench: pull_pull (two cables between a motor pulley and a load pulley), single_cable (one "
     "cable, its far end held by a load cell), lumped_drive (a drive of unknown geometry, seen from its two shafts), "
     "capstan_band (a band round a drum).",
     "", "\"pull_pull\"", every},
    {"", "sample_rate_hz", "number", "Hz", "Rate of the samples.", "from the median distance of the times",
     "200", every},
    {"", "units", "object", "", "Unit of each column, in SI; each column but run is named here.",
     "the SI units of the known columns", "{\"t\": \"s\", \"motor_angle\": \"rad\"}", every},
    {"", "nominal", "object", "", "What is known of the bench before the recording is looked at.", "", "{}",
     with_geometry},
    {"", "noise_std", "object", "channel's unit", "Standard deviation of one reading, by channel.",
     "estimated from the second differences of the samples", "{\"load_torque\": 0.01}", every},
    {"", "encoder_step", "object", "channel's unit", "Step of an encoder or converter, by channel.",
     "no step", "{\"motor_angle\": 0.000767}", every},
    {"", "torque_step", "number", "N m", "Step of all torque channels without a step of their own.",
     "no step", "0.00004", every},
    {"", "tension_sensors", "array of objects", "", "Where each tension sensor is.", "no tension sensors",
     "[{\"channel\": \"tension_1\", \"cable\": \"A\", \"s\": 0.5}]", with_geometry},
    {"", "runs", "array of objects", "", "The runs, in the order in which they were made.",
     "one run for each number in the column run", "[]", every},
    {"", "notes", "string", "", "Anything that a reader should know.", "none",
     "\"a template: replace every number\"", every},
    {"", "import", "object", "", "Written by `capstan import`: files, mapping and repairs.", "none", "{}", 0},
    {"nominal", "L", "number", "m", "Length of one cable, from pulley to pulley.", "", "2.0", with_geometry},
    {"nominal", "R_profile", "array of objects", "",
     "The bends, piece after piece from the motor's end; they fill L.", "a straight cable", "[]",
     with_geometry},
    {"nominal", "r_input", "number", "m", "Radius of the motor pulley.", "", "0.02", with_geometry},
    {"nominal", "r_load", "number", "m", "Radius of the load pulley.", "", "0.04", with_geometry},
    {"nominal", "K", range, "N/m",
     "Stiffness of one complete cable, end to end. State K or EA, as a value or as a range [low, high] that "
     "holds it with 95%; the nominal value is then its geometric mean.",
     "EA / L", "", with_geometry},
    {"nominal", "EA", range, "N", "Axial stiffness of the cable: force over strain. State K or EA.",
     "K L; without both it is fitted", "9000", with_geometry},
    {"nominal", "mu_d", range, "", "Dynamic friction coefficient between cable and sheath.", "it is fitted",
     "0.12", with_geometry},
    {"nominal", "mu_s", "number", "", "Static friction coefficient; not below mu_d.", "mu_d", "0.12",
     with_geometry},
    {"nominal", "rotor_inertia", "number", "kg m2", "Of the motor with its pulley.", "0", "0.000002", pair},
    {"nominal", "load_pulley_inertia", "number", "kg m2", "Of the load pulley.", "0", "0.00001", pair},
    {"nominal", "cable_mass_per_length", "number", "kg/m", "Of one cable.", "not used", "0.003",
     with_geometry},
    {"nominal.R_profile", "s0", "number", "m", "Where the piece begins.", "", "0", with_geometry},
    {"nominal.R_profile", "s1", "number", "m", "Where it ends.", "", "2.0", with_geometry},
    {"nominal.R_profile", "R", "number", "m", "Its bend radius.", "the piece is straight", "0.5",
     with_geometry},
    {"tension_sensors", "channel", "string", "", "Column of the sensor.", "", "\"tension_1\"", with_geometry},
    {"tension_sensors", "cable", "string", "", "\"A\" or \"B\"; a single cable is A.", "\"A\"", "\"A\"",
     with_geometry},
    {"tension_sensors", "s", "number", "m", "Place along the cable from the motor's end.", "", "0.5",
     with_geometry},
    {"runs", "run", "number", "", "Number of the run, as in the column run.", "", "1", every},
    {"runs", "protocol", "string", "", "What was done in it.", "none", "\"sines\"", every},
    {"runs", "source", "string", "", "The same, where no protocol has a name.", "none", "", every},
    {"runs", "t_session_start", "number", "s", "When the run began in the session.", "0", "0", every},
    {"runs", "duration", "number", "s", "How long it lasted; a note, compared with the times.", "from the times", "", every},
    {"runs", "T0", range, "N", "Pretension of a cable when the run began.",
     "where no run states it, it is fitted as one of all runs", "30", with_geometry},
    {"runs", "output", "string", "", "What held the load pulley: locked or handle.", "not known",
     "\"handle\"", every},
    {"runs", "driven", "array of strings", "", "The channels that a model takes as inputs.",
     "those of the mode (see the channels)", "[\"motor_torque\", \"load_angle\"]", every},
    {"runs", "condition", "object", "",
     "What was set for the run and stays during it: a number for each condition, its unit in the name. A "
     "diagnosis tells whether a number of the bench follows it.",
     "none", "{\"roll_deg\": -45}", every},
    {"runs", "torque_zero_before_Nm", "number", "N m",
     "Reading of the unloaded motor torque sensor before the run.", "not known", "", every},
};

const std::vector<KnownChannel> shaft_channels = {
    {channel::motor_angle, "rad", "angle of the motor pulley; positive reels cable A in"},
    {channel::motor_torque, "N m", "torque of the motor; positive drives that way"},
    {channel::load_angle, "rad", "angle of the load pulley; positive the way it turns when cable A pulls"},
    {channel::load_torque, "N m",
     "torque that the transmission puts on the load; positive in the same direction"},
    {channel::motor_current, "A",
     "current of the motor, where its torque was not recorded (lumped_drive); its torque constant is fitted"},
};
const std::vector<KnownChannel> band_channels = {
    {"displacement", "m", "motion of the drum's surface"},
    {"velocity", "m/s", "its speed"},
    {"friction_force", "N", "force of the damper at the drum"},
};

ordered_json example_of(const RecordingKey& key) {
    return ordered_json::parse(key.example);
}

ordered_json section_template(std::string_view section, BenchMode mode) {
    ordered_json object = ordered_json::object();
    for (const RecordingKey& key : keys) {
        if (key.section == section && key.concerns(mode) && !key.example.empty())
            object[std::string(key.name)] = example_of(key);
    }
    return object;
}

std::string inner_section(const RecordingKey& key) {
    return (key.section.empty() ? "" : std::string(key.section) + ".") + std::string(key.name);
}

ordered_json schema_of(std::string_view section);

ordered_json type_schema(const RecordingKey& key) {
    ordered_json schema;
    if (key.type == "number") {
        schema["type"] = "number";
    } else if (key.type == range) {
        schema["type"] = {"number", "array"};
        schema["items"] = {{"type", "number"}, {"exclusiveMinimum", 0}};
        schema["minItems"] = schema["maxItems"] = 2;
    } else if (key.type == "string") {
        schema["type"] = "string";
        if (key.name == "mode") {
            for (const NamedMode& mode : modes) schema["enum"].push_back(mode.name);
        }
        if (key.name == "output") schema["enum"] = {"locked", "handle"};
        if (key.name == "cable") schema["enum"] = {"A", "B"};
    } else if (key.type == "array of strings") {
        schema["type"] = "array";
        schema["items"]["type"] = "string";
    } else if (key.type == "array of objects") {
        schema["type"] = "array";
        schema["items"] = schema_of(inner_section(key));
    } else {
        schema = schema_of(inner_section(key));
        if (key.name == "units") schema["additionalProperties"]["type"] = "string";
        if (key.name == "condition") schema["additionalProperties"]["type"] = "number";
        if (key.name == "noise_std" || key.name == "encoder_step")
            schema["additionalProperties"]["exclusiveMinimum"] = 0;
    }
    return schema;
}

ordered_json schema_of(std::string_view section) {
    ordered_json schema = {{"type", "object"}};
    for (const RecordingKey& key : keys) {
        if (key.section != section) continue;
        ordered_json entry = type_schema(key);
        entry["description"] =
            std::string(key.meaning) + (key.unit.empty() ? "" : " [" + std::string(key.unit) + "]");
        schema["properties"][std::string(key.name)] = entry;
        // Keys of some kinds of bench only cannot be required of all.
        if (key.is_required() && (key.modes == every || (!section.empty() && section != "runs")))
            schema["required"].push_back(key.name);
    }
    if (section == "nominal") schema["not"]["required"] = {"K", "EA"};
    return schema;
}

}  // namespace

const std::vector<RecordingKey>& recording_keys() {
    return keys;
}

std::string_view mode_name(BenchMode mode) {
    for (const NamedMode& named : modes) {
        if (named.mode == mode) return named.name;
    }
    return "";
}

std::optional<BenchMode> mode_named(std::string_view name) {
    if (name == "band") return BenchMode::capstan_band;
    for (const NamedMode& named : modes) {
        if (named.name == name) return named.mode;
    }
    return std::nullopt;
}

const std::vector<KnownChannel>& known_channels(BenchMode mode) {
    return mode == BenchMode::capstan_band ? band_channels : shaft_channels;
}

std::vector<std::string> usual_driven_channels(BenchMode mode, const std::vector<Channel>& recorded) {
    const auto has = [&](std::string_view name) {
        return std::any_of(recorded.begin(), recorded.end(),
                           [&](const Channel& channel) { return channel.name == name; });
    };
    if (mode == BenchMode::capstan_band) return {has("displacement") ? "displacement" : "tension_1"};
    if (mode != BenchMode::lumped_drive) return usual_driven_channels(mode);
    if (has(channel::motor_angle)) {
        if (has(channel::load_torque)) return usual_driven_channels(mode);
        return {channel::motor_angle};
    }
    std::vector<std::string> driven = {has(channel::motor_torque) ? channel::motor_torque
                                                                  : channel::motor_current};
    if (has(channel::load_torque) && has(channel::load_angle)) driven.emplace_back(channel::load_angle);
    return driven;
}

std::vector<std::string> usual_driven_channels(BenchMode mode) {
    switch (mode) {
        case BenchMode::pull_pull:
            return {channel::motor_torque, channel::load_angle};
        case BenchMode::single_cable:
            return {channel::motor_angle};
        case BenchMode::lumped_drive:
            return {channel::motor_angle, channel::load_torque};
        case BenchMode::capstan_band:
            break;
    }
    return {"displacement"};
}

std::string_view channel_unit(std::string_view channel) {
    if (channel == "t") return "s";
    for (const auto* list : {&shaft_channels, &band_channels}) {
        for (const KnownChannel& known : *list) {
            if (known.name == channel) return known.unit;
        }
    }
    return channel.starts_with("tension_") ? "N" : "";
}

std::string recording_template(BenchMode mode) {
    ordered_json sidecar = section_template("", mode);
    sidecar["mode"] = mode_name(mode);
    sidecar["units"] = {{"t", "s"}};
    for (const KnownChannel& known : known_channels(mode)) {
        if (known.name != channel::motor_current) sidecar["units"][std::string(known.name)] = known.unit;
    }
    if (mode == BenchMode::capstan_band) sidecar["units"]["tension_1"] = "N";
    sidecar["noise_std"] = ordered_json::object();
    sidecar["encoder_step"] = ordered_json::object();
    if (mode == BenchMode::capstan_band) sidecar.erase("torque_step");
    if (sidecar.contains("nominal")) {
        sidecar["nominal"] = section_template("nominal", mode);
        sidecar["nominal"]["R_profile"] = ordered_json::array({section_template("nominal.R_profile", mode)});
        sidecar["units"]["tension_1"] = "N";
    }
    ordered_json run = section_template("runs", mode);
    run["driven"] = usual_driven_channels(mode);
    if (mode != BenchMode::pull_pull) run.erase("output");
    sidecar["runs"] = ordered_json::array({run});
    return sidecar.dump(2) + "\n";
}

std::string recording_schema() {
    ordered_json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                           {"title", "Sidecar of a recording of a cable-conduit bench"}};
    schema.update(schema_of(""));
    return schema.dump(2) + "\n";
}

}  // namespace capstan
