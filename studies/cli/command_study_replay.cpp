#include <fmt/format.h>

#include <cmath>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/text_table.h"
#include "capstan/cli/usage_error.h"
#include "capstan/placement/replay.h"
#include "capstan/placement/stored_study.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

using nlohmann::ordered_json;

std::vector<int> counted_from_one(std::vector<int> nodes) {
    for (int& node : nodes) ++node;
    return nodes;
}

// One of the addresses, from 1; a UsageError says what the study has.
int position(const Invocation& invocation, std::string_view option, std::size_t count) {
    const std::int64_t given = invocation.whole(option);
    if (given > static_cast<std::int64_t>(count)) {
        throw UsageError(
            fmt::format("capstan study replay: --{} is {}, but the study has 1 to {}; `capstan study show` "
                        "lists them",
                        option, given, count));
    }
    return static_cast<int>(given - 1);
}

std::string tensions_text(const std::vector<double>& tension_N) {
    std::string text;
    for (const double tension : tension_N) text += fmt::format(" {:7.3f}", tension);
    return text;
}

// What to look at first: the estimates nearest to the truth and farthest from it would hide the order of the
// configuration, so all are listed in it.
std::string in_words(const Replay& replayed, const storage::ScenarioRecord& scenario,
                     const std::string& noise, std::int64_t repetition) {
    std::string text =
        fmt::format("Repetition {} at sample {} ({}), noise {}\n\nTrue tension [N], nodes 1 to {}:\n {}\n",
                    repetition, scenario.sample, scenario.regime, noise, replayed.true_tension_N.size(),
                    tensions_text(replayed.true_tension_N));
    text += "\nEach sensor alone, direction unknown (+ towards the load, - towards the motor, 0 rests):\n\n";
    storage::QueryResult sensors{
        {"node", "true_N", "reading_N", "error_N", "directions", "patterns_that_verify"}, {}};
    for (const ReplayedSensor& sensor : replayed.sensors) {
        double error_N = 0.0;
        for (std::size_t node = 0; node < sensor.tension_N.size(); ++node) {
            error_N +=
                std::abs(sensor.tension_N[node] - replayed.true_tension_N[node]) / sensor.tension_N.size();
        }
        sensors.rows.push_back({std::int64_t{sensor.node + 1}, replayed.true_tension_N[sensor.node],
                                sensor.reading_N, error_N, sensor.directions,
                                std::int64_t{sensor.verifying_patterns}});
    }
    text += as_table(sensors) + "\nFused:\n\n";
    storage::QueryResult fused{{"layout", "nodes", "method", "error_N"}, {}};
    for (const ReplayedEstimate& estimate : replayed.estimates) {
        fused.rows.push_back({estimate.layout,
                              fmt::format("{}", fmt::join(counted_from_one(estimate.nodes), ",")),
                              estimate.method, estimate.mean_abs_error_N});
    }
    return text + as_table(fused);
}

ordered_json in_json(const Replay& replayed) {
    ordered_json json = {{"true_tension_N", replayed.true_tension_N}};
    for (const ReplayedSensor& sensor : replayed.sensors) {
        json["sensors"].push_back({{"node", sensor.node + 1},
                                   {"reading_N", sensor.reading_N},
                                   {"verifying_patterns", sensor.verifying_patterns},
                                   {"directions", sensor.directions},
                                   {"tension_N", sensor.tension_N}});
    }
    for (const ReplayedEstimate& estimate : replayed.estimates) {
        json["estimates"].push_back({{"layout", estimate.layout},
                                     {"nodes", counted_from_one(estimate.nodes)},
                                     {"method", estimate.method},
                                     {"mean_abs_error_N", estimate.mean_abs_error_N},
                                     {"tension_N", estimate.tension_N}});
    }
    return json;
}

ExitCode run(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    const StoredStudy stored = load_stored_study(database, id);
    const auto& study = stored.description;
    const ReplayAddress address{
        position(invocation, "scenario", study.scenarios.size()),
        position(invocation, "noise", study.noise_levels.size()),
        position(invocation, "repetition", static_cast<std::size_t>(study.study.repetitions))};
    const Replay replayed = replay(stored.plan, address, static_cast<int>(invocation.whole("jobs")));
    deliver(invocation, invocation.has("json") ? json_text(in_json(replayed))
                                               : in_words(replayed, study.scenarios[address.scenario_index],
                                                          study.noise_levels[address.noise_index].label,
                                                          address.repetition + 1));
    return ExitCode::success;
}

}  // namespace

Command study_replay_command() {
    constexpr double most = 1e9;
    return {
        "study replay",
        "Look at one repetition of a study: readings, estimates, errors.",
        "Draws one repetition again, alone, as it ran in the study: the same readings, the same estimates. "
        "Instants, noise levels and repetitions count from 1, as `capstan study show` lists them.",
        {study_argument},
        {{"scenario", '\0', OptionKind::whole_number, "N", "Which instant.", "1", {}, 1, most},
         {"noise", '\0', OptionKind::whole_number, "N", "Which noise level.", "1", {}, 1, most},
         {"repetition", '\0', OptionKind::whole_number, "N", "Which repetition.", "1", {}, 1, most},
         database_option,
         jobs_option,
         output_option,
         json_option,
         help_option},
        {"capstan study replay --scenario 2 --repetition 17"},
        run};
}

}  // namespace capstan::cli
