#include "capstan/gap_trial/trial_recordings.h"

#include <mutex>

#include "capstan/platform/parallel_for.h"

namespace capstan::gap_trial {

TrialLabels make_recordings(const TrialOptions& options, const std::filesystem::path& folder, int jobs,
                            const CaseProgress& on_progress) {
    const std::vector<PlannedCase> plan = plan_trial(options);
    TrialLabels labels{options, random_salt(), std::vector<CaseLabel>(plan.size())};
    std::mutex telling;
    int done = 0;
    parallel_for_each_index(static_cast<int>(plan.size()), jobs, [&](int index) {
        const auto slot = static_cast<std::size_t>(index);
        labels.cases[slot] = make_case(plan[slot], options, folder);
        const std::lock_guard lock(telling);
        on_progress("simulating", ++done, static_cast<int>(plan.size()));
    });
    return labels;
}

}  // namespace capstan::gap_trial
