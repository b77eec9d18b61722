#include <fmt/format.h>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/study_words.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

using nlohmann::ordered_json;
using storage::StudyDescription;

std::string scenarios_text(const StudyDescription& study) {
    std::string text = "Instants (scenarios):\n";
    for (std::size_t k = 0; k < study.scenarios.size(); ++k) {
        const auto& scenario = study.scenarios[k];
        text += fmt::format("  {:>2}  {:<16} sample {:>4} at {:.3f} s, motor end moves {}\n", k + 1,
                            scenario.regime, scenario.sample, scenario.time_s, scenario.motion);
    }
    return text;
}

std::string noise_text(const StudyDescription& study) {
    std::string text = "Noise levels:\n";
    for (std::size_t k = 0; k < study.noise_levels.size(); ++k) {
        text += fmt::format("  {:>2}  {}\n", k + 1, study.noise_levels[k].label);
    }
    return text;
}

std::string in_words(std::int64_t id, const StudyDescription& study, std::size_t pending) {
    const auto& head = study.study;
    double length_m = 0.0;
    double wrap_rad = 0.0;
    for (const auto& segment : study.cable_segments) {
        length_m += segment.length_m;
        wrap_rad += segment.wrap_angle_rad;
    }
    std::vector<std::string> methods;
    for (const auto& method : study.fusion_methods) methods.push_back(method.title);
    const std::size_t units = study.work_units.size();

    std::string text = fmt::format("Study {}: {} ({}, {} of {} units)\n\n", id, head.name, head.status,
                                   units - pending, units);
    text += fmt::format("Cable:        {:.4g} m in {} segments, {:.4g} rad of wrap; nodes 1 to {}\n",
                        length_m, head.segments, wrap_rad, head.segments + 1);
    text += fmt::format("Draws:        {} repetitions, seed {}\n", head.repetitions, head.seed);
    text += fmt::format("Layouts:      {}, with {} different sets of sensors\n", study.layouts.size(),
                        study.sensor_sets.size());
    text +=
        wrapped(fmt::format("{}", fmt::join(methods, "; ")), 100, "Methods:      ", "              ") + "\n";
    text += fmt::format("Program:      capstan {}\n\n", head.program_version);
    text += scenarios_text(study) + "\n" + noise_text(study) + "\n";
    text +=
        head.status == "complete"
            ? fmt::format(
                  "`capstan recommend {0}` says what follows; `capstan study show {0} --config` shows the configuration.\n",
                  id)
            : fmt::format("`capstan study resume {0}` goes on with it.\n", id);
    return text;
}

ordered_json number_or_null(const std::optional<double>& number) {
    return number ? ordered_json(*number) : ordered_json(nullptr);
}

ordered_json in_json(std::int64_t id, const StudyDescription& study, std::size_t pending) {
    const auto& head = study.study;
    ordered_json json = {{"study_id", id},
                         {"name", head.name},
                         {"status", head.status},
                         {"units_done", study.work_units.size() - pending},
                         {"units", study.work_units.size()},
                         {"program_version", head.program_version},
                         {"seed", head.seed},
                         {"repetitions", head.repetitions},
                         {"segments", head.segments},
                         {"layouts", study.layouts.size()},
                         {"sensor_sets", study.sensor_sets.size()}};
    for (const auto& method : study.fusion_methods) json["methods"].push_back(method.method);
    for (std::size_t k = 0; k < study.scenarios.size(); ++k) {
        const auto& scenario = study.scenarios[k];
        json["scenarios"].push_back({{"scenario", k + 1},
                                     {"regime", scenario.regime},
                                     {"sample", scenario.sample},
                                     {"time_s", scenario.time_s},
                                     {"motion", scenario.motion}});
    }
    for (std::size_t k = 0; k < study.noise_levels.size(); ++k) {
        const auto& level = study.noise_levels[k];
        json["noise_levels"].push_back({{"noise", k + 1},
                                        {"label", level.label},
                                        {"multiplicative_ratio", level.multiplicative_ratio},
                                        {"additive_N", level.additive_N},
                                        {"bias_N", level.bias_N},
                                        {"quantisation_N", number_or_null(level.quantisation_N)},
                                        {"range_N", number_or_null(level.range_N)}});
    }
    json["config_toml"] = head.config_toml;
    return json;
}

ExitCode run(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    if (invocation.has("json")) {
        deliver(invocation, study_json(database, id));
        return ExitCode::success;
    }
    const StudyDescription study = storage::load_study(database, id);
    const std::size_t pending = storage::pending_units(database, id).size();
    deliver(invocation, invocation.has("config") ? study.study.config_toml : in_words(id, study, pending));
    return ExitCode::success;
}

}  // namespace

std::string study_json(storage::Database& database, std::int64_t study_id) {
    const StudyDescription study = storage::load_study(database, study_id);
    return json_text(in_json(study_id, study, storage::pending_units(database, study_id).size()));
}

Command study_show_command() {
    return {
        "study show",
        "Show what a study is and how far it has come.",
        "Shows a study's cable, instants, noise levels, layouts and methods, and how far it has come; with "
        "--config the configuration in full, from which the study can be run again.",
        {study_argument},
        {database_option,
         {"config", '\0', OptionKind::flag, "",
          "Print the stored configuration (TOML), every key written out."},
         output_option,
         json_option,
         help_option},
        {"capstan study show", "capstan study show 3 --config -o again.toml"},
        run};
}

}  // namespace capstan::cli
