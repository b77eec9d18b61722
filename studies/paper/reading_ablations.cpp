#include "capstan/paper/reading_ablations.h"

#include <stdlib.h>

#include <filesystem>
#include <functional>

#include "capstan/cable/invalid_input.h"
#include "capstan/paper/placement_comparison.h"
#include "capstan/platform/work_meter.h"

namespace capstan::paper {

namespace {

// Results that nobody keeps.
class TemporaryResults {
  public:
    TemporaryResults()
        : folder_(new_folder()), database_(storage::Database::open_or_create(folder_ / "results.db")) {}
    ~TemporaryResults() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    TemporaryResults(const TemporaryResults&) = delete;
    TemporaryResults& operator=(const TemporaryResults&) = delete;

    storage::Database& database() { return database_; }

  private:
    static std::filesystem::path new_folder() {
        std::string name = (std::filesystem::temp_directory_path() / "capstan-paper-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw InvalidInput({"no temporary folder can be made beside " + name +
                                "; set TMPDIR to one that can be written"});
        return name;
    }

    std::filesystem::path folder_;
    storage::Database database_;
};

constexpr int other_instants = 8;  // of each regime

StudyPlan at_other_instants(StudyPlan plan) {
    const auto reached = samples_by_regime(plan);
    for (RegimeInstants& regime : plan.regimes) {
        const auto found = reached.find(regime.regime);
        if (found == reached.end()) continue;
        const std::vector<int>& samples = found->second;
        regime.samples.clear();
        for (int k = 0; k < other_instants; ++k) {
            const std::size_t at = samples.size() * (2 * k + 1) / (2 * other_instants);
            if (regime.samples.empty() || regime.samples.back() != samples[at])
                regime.samples.push_back(samples[at]);
        }
    }
    return plan;
}

struct Change {
    const char* name;
    const char* meaning;
    std::function<StudyPlan(StudyPlan)> of_plan;
    OneSensor one_sensor = OneSensor::both_ends;
};

StudyPlan unchanged(StudyPlan plan) {
    return plan;
}

const std::vector<Change>& changes() {
    static const std::vector<Change> all = {
        {"farthest_first",
         "direction patterns are tried in the reverse order: the farthest from the previous one first",
         [](StudyPlan plan) {
             plan.pattern_order = PatternOrder::farthest_first;
             return plan;
         }},
        {"other_instants", "eight instants spread evenly over each regime instead of those that were matched",
         at_other_instants},
        {"one_sensor_proximal",
         "the one sensor of Even and Both is at the proximal end instead of at either end", unchanged,
         OneSensor::proximal_end},
        {"one_sensor_distal", "the one sensor of Even and Both is at the distal end instead of at either end",
         unchanged, OneSensor::distal_end},
        {"weights_of_regime",
         "the weights of the W methods come from the regime that is fused instead of from mass motion",
         [](StudyPlan plan) {
             plan.weight_source = WeightSource::same_regime;
             return plan;
         }},
        {"stiffness_per_metre",
         "Table I's 2 kN/m is read per metre of elongation of the 2 m cable: EA is twice as large; eight instants of each "
         "regime",
         [](StudyPlan plan) {
             plan.transmission.cable.axial_stiffness_N *= 2.0;
             return at_other_instants(plan);
         }},
        {"consistent_rules",
         "our rules of the model (engine/README.md) instead of the paper's; eight instants of each regime",
         [](StudyPlan plan) {
             plan.transmission.rules = ModelRules::consistent();
             return at_other_instants(plan);
         }},
        {"distal_side_admitted", "an estimate may let the blocked distal end move",
         [](StudyPlan plan) {
             plan.distal_side = DistalSide::admitted;
             return plan;
         }},
    };
    return all;
}

std::vector<storage::PaperComparisonRecord> rows_of(const StudyPlan& plan, OneSensor one_sensor,
                                                    const RunOptions& options) {
    TemporaryResults results;
    const RunOutcome outcome = run_study(results.database(), plan, "", options);
    return compare_placement_with(one_sensor, results.database(), outcome.study_id);
}

}  // namespace

bool accounts_for(const storage::PaperComparisonRecord& ablated,
                  const storage::PaperComparisonRecord& configured) {
    if (!configured.paper_N) return false;
    const double before_N = configured.ours_N - *configured.paper_N;
    const double after_N = ablated.ours_N - *configured.paper_N;
    return ablated.reason == agrees || before_N * after_N < 0.0;
}

AblatedTable ablate_readings(const StudyPlan& plan, const RunOptions& options) {
    const auto counted = [&](const StudyPlan& of, OneSensor one_sensor) {
        const auto rows = [&] {
            const MeterScope uncounted(nullptr);
            return rows_of(of, one_sensor, options);
        }();
        note_work();
        return rows;
    };
    expect_work(1.0 + static_cast<double>(changes().size()));
    AblatedTable table{counted(plan, OneSensor::both_ends), {}};
    for (const Change& change : changes()) {
        table.ablations.push_back(
            {change.name, change.meaning, counted(change.of_plan(plan), change.one_sensor)});
    }
    return table;
}

}  // namespace capstan::paper
