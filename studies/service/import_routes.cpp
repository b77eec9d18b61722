// From a laboratory's log to a diagnosis: a mapping is proposed, tried and used. Every request brings the
// files again, so that the service keeps nothing.
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/mapping_edit.h"
#include "capstan/platform/files.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/reports/answer.h"
#include "capstan/service/cost_estimate.h"
#include "capstan/service/import_folder.h"
#include "capstan/service/routes.h"

namespace capstan::service {

namespace {

constexpr std::size_t curve_points = 40000;  // of all channels and runs together
constexpr const char* mapping_name = "import.toml";

ordered_json lines_of(const std::string& text) {
    ordered_json lines = ordered_json::array();
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        if (!line.empty()) lines.push_back(line);
    }
    return lines;
}

template <class Number>
void state(ordered_json& json, const char* key, const std::optional<Number>& number) {
    if (number) json[key] = *number;
}

ordered_json mapping_json(const std::string& toml) {
    ordered_json json = {{"mapping", toml}, {"problems", ordered_json::array()}};
    try {
        const imports::Mapping mapping = imports::parse_mapping(toml, mapping_name);
        json["time"] = {{"column", mapping.time.column}, {"unit", mapping.time.unit}};
        json["channels"] = ordered_json::array();
        for (const imports::ChannelMapping& channel : mapping.channels) {
            ordered_json& row = json["channels"].emplace_back();
            row = {{"name", channel.name},        {"file", channel.from.file},
                   {"table", channel.from.table}, {"column", channel.from.column},
                   {"unit", channel.unit},        {"sign", channel.sign},
                   {"zero", channel.zero}};
            state(row, "scale", channel.scale);
            state(row, "counts_per_turn", channel.counts_per_turn);
            state(row, "torque_constant", channel.torque_constant);
            state(row, "clock_offset_s", channel.clock_offset_s);
        }
        if (mapping.recording.is_object() && mapping.recording.contains("mode"))
            json["mode"] = mapping.recording["mode"];
    } catch (const InvalidInput& error) {
        json["problems"] = error.problems();
    }
    return json;
}

// What a channel can be, for the kinds of bench together.
ordered_json roles() {
    ordered_json list = {{{"name", "time"}, {"unit", "s"}, {"meaning", "the clock of the log"}}};
    std::set<std::string_view> listed;
    for (const BenchMode mode :
         {BenchMode::pull_pull, BenchMode::single_cable, BenchMode::lumped_drive, BenchMode::capstan_band}) {
        for (const KnownChannel& channel : known_channels(mode)) {
            if (listed.insert(channel.name).second)
                list.push_back({{"name", channel.name},
                                {"unit", channel.unit},
                                {"meaning", channel.meaning},
                                {"common", mode != BenchMode::capstan_band}});
        }
    }
    return list;
}

ordered_json suggestion(const RouteContext& context, const http::Request& request) {
    const ImportFolder folder(request, context.options.commands);
    ordered_json json = ordered_json::parse(folder.import({"--list", "--json"}));
    std::vector<std::string> words{"--suggest", "--json"};
    if (const http::FormPart* kind = request.part("kind"); kind != nullptr && !kind->content.empty())
        words.push_back("--kind=" + std::string(kind->content));
    ordered_json failures = ordered_json::array();
    std::string toml = "[channels]\n";
    json["guesses"] = ordered_json::array();
    try {
        const ordered_json proposed = ordered_json::parse(folder.import(words));
        toml = proposed.at("mapping").get<std::string>();
        json["guesses"] = proposed.at("guesses");
    } catch (const BadRequest& error) {  // the columns can still be assigned by hand
        failures = lines_of(error.what());
    }
    json.update(mapping_json(toml));
    if (!failures.empty()) json["problems"] = failures;
    json["roles"] = roles();
    json["units"] = ordered_json::array();
    std::istringstream units(imports::known_units());
    for (std::string unit; std::getline(units >> std::ws, unit, ',');) json["units"].push_back(unit);
    return json;
}

imports::MappingEdit edit_of(const nlohmann::json& body) {
    imports::MappingEdit edit;
    edit.channel = member<std::string>(body, "channel");
    if (edit.channel.empty() || edit.channel.size() > 100) throw BadRequest("'channel' must be a name");
    if (body.contains("remove")) edit.remove = member<bool>(body, "remove");
    if (body.contains("column")) {
        edit.from = imports::ColumnPlace{"", "", member<std::string>(body, "column")};
        if (body.contains("file")) edit.from->file = member<std::string>(body, "file");
        if (body.contains("table")) edit.from->table = member<std::string>(body, "table");
    }
    if (body.contains("unit")) edit.unit = member<std::string>(body, "unit");
    const auto number = [&](const char* key) {
        return body.contains(key) ? std::optional(member<double>(body, key)) : std::nullopt;
    };
    edit.sign = number("sign");
    if (edit.sign && std::abs(*edit.sign) != 1.0) throw BadRequest("'sign' must be 1 or -1");
    edit.zero = number("zero");
    edit.scale = number("scale");
    edit.counts_per_turn = number("counts_per_turn");
    edit.torque_constant = number("torque_constant");
    return edit;
}

ordered_json edited(const nlohmann::json& body) {
    const auto toml = member<std::string>(body, "mapping");
    if (!body.contains("edit")) return mapping_json(toml);
    if (!body["edit"].is_object()) throw BadRequest("'edit' must be an object");
    try {
        return mapping_json(imports::edited_mapping(toml, mapping_name, edit_of(body["edit"])));
    } catch (const InvalidInput& error) {
        throw BadRequest(error.what());
    }
}

ordered_json curves_of(const Recording& recording) {
    ordered_json curves = ordered_json::array();
    const std::size_t limit = std::max<std::size_t>(
        curve_points / std::max<std::size_t>(recording.channels.size() * recording.runs.size(), 1), 50);
    for (const RecordedRun& run : recording.runs) {
        const std::size_t step = reports::drawn_every(run.time_s.size(), limit);
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            ordered_json curve = {{"run", run.number},
                                  {"channel", recording.channels[channel].name},
                                  {"unit", recording.channels[channel].unit},
                                  {"time_s", ordered_json::array()},
                                  {"value", ordered_json::array()}};
            for (std::size_t k = 0; k < run.time_s.size(); k += step) {
                curve["time_s"].push_back(run.time_s[k]);
                curve["value"].push_back(run.values[channel][k]);
            }
            curves.push_back(std::move(curve));
        }
    }
    return curves;
}

ordered_json trial(const RouteContext& context, const http::Request& request) {
    const ImportFolder folder(request, context.options.commands);
    std::string answer;
    const Recording recording = read_recording(folder.import_recording(answer));
    ordered_json json = ordered_json::parse(answer);
    json["curves"] = curves_of(recording);
    return json;
}

Job diagnose(RouteContext& context, const http::Request& request) {
    const ImportFolder folder(request, context.options.commands);
    std::string answer;
    std::filesystem::path samples = folder.import_recording(answer);
    const std::string log = read_file(samples);
    return context.queue.add_recording(JobKind::diagnosis, folder.name() + ".csv", log,
                                       read_file(samples.replace_extension(".json")));
}

ordered_json diagnosis_cost(const RouteContext& context, const http::Request& request) {
    const ImportFolder folder(request, context.options.commands);
    std::string answer;
    return cost_of_diagnosis(context.options.commands, folder.import_recording(answer).string());
}

}  // namespace

std::vector<Route> import_routes(RouteContext& context) {
    const auto suggest = [&](const http::Request& request, http::Response& response) {
        send_json(response, suggestion(context, request));
    };
    const auto edit = [](const http::Request& request, http::Response& response) {
        send_json(response, edited(body_of(request)));
    };
    const auto try_import = [&](const http::Request& request, http::Response& response) {
        send_json(response, trial(context, request));
    };
    const auto start = [&](const http::Request& request, http::Response& response) {
        send_json(response, job_json(diagnose(context, request)), 202);
    };
    const auto tell_cost = [&](const http::Request& request, http::Response& response) {
        send_json(response, diagnosis_cost(context, request));
    };
    const ApiField logs{"log", "[binary]", "The files, at most 32: text, MATLAB, HDF5, ROS bag, MCAP, XLSX"};
    const ApiField mapping{"mapping", "string", "The text of import.toml"};
    std::vector<Route> routes{
        {"post",
         "/api/import/suggestion",
         "suggestMapping",
         "Propose a mapping of a log, as `capstan import --suggest` does, and list the log's columns with a few "
         "numbers of each for drawing them",
         "The columns, the mapping (TOML and its channels), each guess with its reason and doubt",
         json_of("object"),
         suggest,
         200,
         {400, 408, 413, 503},
         {logs,
          {"kind", "string", "pull_pull, single_cable, lumped_drive or band; guessed if absent", false}},
         "multipart/form-data"},
        {"post",
         "/api/import/mapping",
         "editMapping",
         "Read the text of a mapping, and change one channel of it where `edit` says so: `channel`, and "
         "`column` (with `table` and `file`), `unit`, `sign`, `zero`, `scale`, `counts_per_turn`, "
         "`torque_constant` or `remove`",
         "The text, its channels, and what is wrong with it",
         json_of("object"),
         edit,
         200,
         {400},
         {mapping, {"edit", "object", "The change", false}}},
        {"post",
         "/api/import/trial",
         "tryImport",
         "Import a log and say what was read and repaired and what looks wrong; nothing is kept",
         "As `capstan import --try --json` writes it, with `curves` of the recording",
         json_of("object"),
         try_import,
         200,
         {400, 408, 413, 503},
         {logs, mapping},
         "multipart/form-data"},
        {"post",
         "/api/import/diagnosis",
         "importAndDiagnose",
         "Import a log and queue the diagnosis of the recording",
         "Its job",
         json_of("Job"),
         start,
         202,
         {400, 408, 413, 503, 507},
         {logs, mapping},
         "multipart/form-data"},
        {"post",
         "/api/import/diagnosis/cost",
         "importedDiagnosisCost",
         "How long the diagnosis of the imported recording would take on this machine, by a pilot",
         "The cost, as of diagnosisCost",
         json_of("object"),
         tell_cost,
         200,
         {400, 408, 413, 503},
         {logs, mapping},
         "multipart/form-data"},
    };
    return in_lane(Lane::imports, std::move(routes));
}

}  // namespace capstan::service
