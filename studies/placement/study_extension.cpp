#include "capstan/placement/study_extension.h"

#include <algorithm>
#include <map>

#include "capstan/cable/invalid_input.h"
#include "capstan/config/config_writer.h"
#include "capstan/placement/intervals.h"
#include "capstan/placement/placement_questions.h"
#include "capstan/storage/study_store.h"

namespace capstan {

namespace {

// Of the candidates with as many sensors as the best, how much better one could still be.
double unresolved_at_each_count_N(const std::vector<PlacementCandidate>& candidates,
                                  const std::vector<Score>& scores, double alpha) {
    std::map<int, std::vector<int>> by_count;
    for (int c = 0; c < static_cast<int>(candidates.size()); ++c)
        by_count[candidates[c].sensor_count].push_back(c);
    double worst_N = 0.0;
    for (auto& [sensors, of_count] : by_count) {
        const auto best = std::min_element(of_count.begin(), of_count.end(), [&](int a, int b) {
            return scores[a].objective_N < scores[b].objective_N;
        });
        const int reference = *best;
        of_count.erase(best);
        for (const auto& [c, difference] : simultaneous_differences(scores, reference, of_count, alpha))
            worst_N = std::max(worst_N, -difference.low_N);
    }
    return worst_N;
}

// The study with the same configuration but for its repetitions, if it is there.
std::optional<std::int64_t> find_same(storage::Database& database, const StudyPlan& plan) {
    const std::string toml = config::config_text(plan, config::Comments::none);
    for (const storage::StudySummary& study : storage::list_studies(database)) {
        if (study.name != plan.name) continue;
        if (storage::load_study(database, study.study_id).study.config_toml == toml) return study.study_id;
    }
    return std::nullopt;
}

RunOutcome run_or_go_on(storage::Database& database, const StudyPlan& plan,
                        const std::string& program_version, const RunOptions& options) {
    const std::optional<std::int64_t> begun = find_same(database, plan);
    if (!begun) return run_study(database, plan, program_version, options);
    RunOutcome outcome;
    outcome.study_id = *begun;
    if (storage::load_study(database, *begun).study.status == "complete") return outcome;
    return resume_study(database, *begun, plan, options);
}

// Looks at a study and at those of twice, four times ... its repetitions.
class Doubling {
  public:
    Doubling(storage::Database& database, const StudyToExtend& study, const Resolution& resolution)
        : database_(database), study_(study), resolution_(resolution) {
        outcome_.run.study_id = study.study_id;
        outcome_.repetitions = study.plan.repetitions;
    }

    ExtensionOutcome run(const std::string& program_version, const RunOptions& options) {
        // A larger study that exists, complete or not, was begun because no smaller one was enough.
        for (int n = repetitions_after(1); n <= resolution_.max_repetitions && n > 0; n *= 2) {
            if (find_same(database_, study_.with_repetitions(n))) doublings_ = rounds_to(n);
        }
        if (doublings_ > 0 && !run_round(program_version, options)) return outcome_;
        while (look() > resolution_.tolerance_N && can_double()) {
            // The intermediate study was not requested.
            if (is_own_) storage::forget_study(database_, outcome_.run.study_id);
            ++doublings_;
            if (!run_round(program_version, options)) return outcome_;
        }
        return outcome_;
    }

  private:
    int repetitions_after(int doublings) const { return study_.plan.repetitions << doublings; }
    int rounds_to(int repetitions) const {
        int rounds = 0;
        while (repetitions_after(rounds) < repetitions) ++rounds;
        return rounds;
    }
    bool can_double() const { return 2LL * repetitions_after(doublings_) <= resolution_.max_repetitions; }

    double look() {
        const double alpha = 0.025 / static_cast<double>(1 << doublings_);
        outcome_.unresolved_N = unresolved_N(database_, outcome_.run.study_id, alpha);
        if (resolution_.on_look) resolution_.on_look(outcome_.repetitions, *outcome_.unresolved_N);
        return *outcome_.unresolved_N;
    }

    // False when it was stopped.
    bool run_round(const std::string& program_version, const RunOptions& options) {
        const StudyPlan plan = study_.with_repetitions(repetitions_after(doublings_));
        const auto before = find_same(database_, plan);
        is_own_ = !before || storage::load_study(database_, *before).study.status != "complete";
        outcome_.run = run_or_go_on(database_, plan, program_version, options);
        outcome_.repetitions = plan.repetitions;
        return outcome_.run.end == RunEnd::complete;
    }

    storage::Database& database_;
    const StudyToExtend& study_;
    const Resolution& resolution_;
    ExtensionOutcome outcome_;
    int doublings_ = 0;
    bool is_own_ = false;
};

}  // namespace

StudyPlan StudyToExtend::with_repetitions(int repetitions) const {
    StudyPlan larger = plan;
    larger.repetitions = repetitions;
    return larger;
}

double unresolved_N(storage::Database& database, std::int64_t study_id, double alpha) {
    const storage::StudyDescription study = storage::load_study(database, study_id);
    const ScenarioFractions fractions = scenario_fractions(study);
    double worst_N = 0.0;
    for (int noise = 0; noise < static_cast<int>(study.noise_levels.size()); ++noise) {
        const auto candidates =
            placement_candidates(study, storage::read_cell_summaries(database, study_id, noise));
        if (candidates.empty()) continue;  // only methods that are told the direction
        const std::vector<int> reference = best_of_regimes(candidates, fractions.regime);
        for (const PlacementQuestion& question :
             placement_questions(candidates, study, fractions, reference)) {
            worst_N = std::max(worst_N, unresolved_at_each_count_N(candidates, question.scores, alpha));
        }
    }
    return worst_N;
}

ExtensionOutcome extend_study(storage::Database& database, const StudyToExtend& study, int repetitions,
                              const std::string& program_version, const RunOptions& options) {
    if (repetitions <= study.plan.repetitions) {
        throw InvalidInput(
            {"study " + std::to_string(study.study_id) + " has " + std::to_string(study.plan.repetitions) +
             " repetitions already; give the number that it is to have in all, which must be more"});
    }
    return {run_or_go_on(database, study.with_repetitions(repetitions), program_version, options),
            repetitions, std::nullopt};
}

ExtensionOutcome extend_until_resolved(storage::Database& database, const StudyToExtend& study,
                                       const Resolution& resolution, const std::string& program_version,
                                       const RunOptions& options) {
    return Doubling(database, study, resolution).run(program_version, options);
}

}  // namespace capstan
