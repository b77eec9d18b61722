#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "capstan/bench_model/model_file.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/effects/effect_catalogue.h"
#include "capstan/gap/effects_twin.h"
#include "capstan/platform/files.h"
#include "full_model.h"

namespace capstan::bench_model {
namespace {

// The messages of the only way to read this text.
std::string problems_in(const std::string& text) {
    try {
        parse_model(text, "m.toml");
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

std::string with(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

TEST(ModelFile, HoldsTheModelToTheBit) {
    const BenchModel model = full_model();
    const std::string text = model_text(model);
    const BenchModel read = parse_model(text, "m.toml");
    EXPECT_EQ(model_text(read), text);
    EXPECT_EQ(read.friction_ratio.value, model.friction_ratio.value);
    EXPECT_EQ(read.friction_ratio.interval->high, model.friction_ratio.interval->high);
    EXPECT_EQ(read.laws[0].law.weights[0].weight, model.laws[0].law.weights[0].weight);
    EXPECT_EQ(read.laws[0].law.terms[0].words, "a \"torque\"");
    EXPECT_EQ(*read.laws[0].law.removed_low, -0.1);
    EXPECT_EQ(read.ranked[0].present, model.ranked[0].present);
    EXPECT_EQ(read.description.bench.curvature[0].bend_radius_m, straight);
}

TEST(ModelFile, PredictsTheSameBitsAsTheDiagnosis) {
    const Recording recording = gap::driven_session();
    const gap::EffectsTwin twin(recording, {.segments = 24});
    const gap::BenchNumbers before = full_split().diagnosis.corrected;
    const gap::BenchNumbers after = parse_model(model_text(full_model()), "m.toml").numbers();
    for (std::size_t run = 0; run < recording.runs.size(); ++run)
        EXPECT_EQ(twin.run(run, after).values, twin.run(run, before).values);
}

// Where a described conduit bends is stated by its path.
TEST(ModelFile, HoldsTheBendsAndTheLoadPulleyOfADriveOfUnknownGeometryAndOfNoOtherBench) {
    BenchModel model = full_model();
    model.recorded_mode = BenchMode::lumped_drive;
    model.bend_at_motor_ratio.value = odd_number(2.0);
    model.bend_at_load_ratio.value = odd_number(0.6);
    model.load_radius_ratio.value = odd_number(0.97);
    const std::string text = model_text(model);
    const gap::BenchNumbers read = parse_model(text, "m.toml").numbers();
    EXPECT_EQ(read.bend_at_motor_ratio, model.bend_at_motor_ratio.value);
    EXPECT_EQ(read.bend_at_load_ratio, model.bend_at_load_ratio.value);
    EXPECT_EQ(read.load_radius_ratio, model.load_radius_ratio.value);
    EXPECT_THROW(parse_model(with(text, "\"lumped_drive\"", "\"pull_pull\""), "m.toml"), InvalidInput);
}

TEST(ModelFile, HoldsEveryEffectOfTheCatalogue) {
    for (const Effect& effect : effect_catalogue()) {
        BenchModel model = full_model();
        BenchEffects effects;
        std::vector<double> values;
        for (const EffectParameter& parameter : effect.parameters)
            values.push_back(odd_number(parameter.typical));
        effect.apply(effects, values);
        model.effects = described_effects(effects, {});
        EXPECT_EQ(model.effects.size(), 1u) << effect.name << " " << effect.variant;
        const BenchModel read = parse_model(model_text(model), "m.toml");
        EXPECT_EQ(effect.values_in(read.numbers().effects), values) << effect.name << " " << effect.variant;
    }
}

TEST(ModelFile, GivesAnIntervalToWhatWasFittedAndToNothingElse) {
    const BenchModel read = parse_model(model_text(full_model()), "m.toml");
    for (const ModelEffect& effect : read.effects) {
        for (const FittedNumber& number : effect.numbers)
            EXPECT_EQ(number.interval.has_value(),
                      number.name == "angle" || (effect.variant == "motor" && number.name == "coulomb"))
                << effect.name << " " << effect.variant << " " << number.name;
    }
    for (const FittedNumber& fault : read.sensors.at(0).faults)
        EXPECT_EQ(fault.interval.has_value(), fault.name == "offset") << fault.name;
    ASSERT_EQ(read.follows.size(), 1u);
    EXPECT_EQ(read.follows[0].changes.size(), 3u);
    for (const FittedNumber& change : read.follows[0].changes)
        EXPECT_EQ(change.interval.has_value(), change.name == "zero_of_load_torque") << change.name;
}

TEST(ModelFile, NamesFileLineAndKeyOfEveryProblem) {
    const std::string text = model_text(full_model());
    const std::string problems =
        problems_in(with(with(text, "[effect.viscous_friction]", "[effect.viscous_frictoin]"),
                         "motor_radius_m = 0.02", "motor_radius_m = \"2 cm\""));
    EXPECT_NE(
        problems.find(
            "m.toml:" +
            std::to_string(std::count(text.begin(),
                                      text.begin() + static_cast<std::ptrdiff_t>(text.find("motor_radius_m")),
                                      '\n') +
                           1) +
            ": bench.motor_radius_m: is a string, but must be a number above 0"),
        std::string::npos)
        << problems;
    EXPECT_NE(problems.find("effect.viscous_frictoin: is not an effect that this program knows; did you mean "
                            "'viscous_friction'?"),
              std::string::npos)
        << problems;
}

TEST(ModelFile, RejectsWhatIsMissingMisspeltOrOutOfRange) {
    const std::string text = model_text(full_model());
    EXPECT_NE(problems_in(with(text, "segments = 40", "segment = 40")).find("did you mean 'segments'?"),
              std::string::npos);
    EXPECT_NE(problems_in(with(text, "segments = 40", "segments = 1")).find("an integer from 2 to 1000"),
              std::string::npos);
    EXPECT_NE(
        problems_in(with(text, "friction_ratio = ", "friction_ratio = -")).find("must be a number above 0"),
        std::string::npos);
    EXPECT_NE(problems_in(with(text, "kind = \"friction\"", "kind = \"frictoin\""))
                  .find("left_over[1].terms[1].features[1].kind"),
              std::string::npos)
        << problems_in(with(text, "kind = \"friction\"", "kind = \"frictoin\""));
    EXPECT_NE(problems_in("a = 1").find("capstan diagnose LOG --save FILE"), std::string::npos);
    EXPECT_NE(problems_in("a = ").find("m.toml:1:"), std::string::npos);
}

// A limit below zero would be no limit, and a step or a lag below zero nothing at all.
TEST(ModelFile, RejectsAFaultThatIsLessThanNone) {
    BenchModel model = full_model();
    const char* channel = "load_torque";
    model.sensors = {{channel, {{"clipping", "N m", 0.5}, {"gain", "", -1.0}, {"offset", "N m", -0.1}}}};
    const std::string text = model_text(model);
    const SensorFaults read = parse_model(text, "m.toml").numbers().sensor_faults.at(channel);
    EXPECT_EQ(read.limit, 0.5);
    EXPECT_EQ(read.gain, -1.0);
    EXPECT_EQ(read.offset, -0.1);
    const std::string problems = problems_in(with(text, "clipping_Nm = ", "clipping_Nm = -"));
    EXPECT_NE(problems.find("sensor.load_torque.clipping_Nm"), std::string::npos) << problems;
    EXPECT_NE(problems.find("must be a finite number of 0 or more"), std::string::npos) << problems;
}

TEST(ModelFile, ReplacesAModelAndNothingElse) {
    const gap::TemporaryFolder scratch;
    const std::filesystem::path folder = scratch.write({"", ""}).parent_path();
    const BenchModel model = full_model();
    write_model(folder / "m.toml", model);
    write_model(folder / "m.toml", model);
    EXPECT_EQ(model_text(read_model(folder / "m.toml")), model_text(model));
    write_file(folder / "study.toml", "[motion]\n");
    EXPECT_THROW(write_model(folder / "study.toml", model), InvalidInput);
    EXPECT_EQ(read_file(folder / "study.toml"), "[motion]\n");
    EXPECT_THROW(write_model(folder / "m.json", model), InvalidInput);
    EXPECT_THROW(read_model(folder / "none.toml"), InvalidInput);
}

}  // namespace
}  // namespace capstan::bench_model
