#include "capstan/placement/study_conclusion.h"

#include "capstan/placement/recommendation.h"
#include "capstan/placement/repetition_blocks.h"
#include "capstan/storage/study_store.h"

namespace capstan {

void conclude_study(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                    const RunOptions& options, StudyTimes& times) {
    double start_s = wall_time_s();
    const auto recommendations = recommend(database, study_id, {plan.worthwhile_gain_N},
                                           fresh_errors(database, study_id, plan, options.jobs));
    std::vector<storage::PaperComparisonRecord> paper;
    if (plan.compare_with_paper && options.compare_with_paper) {
        paper = options.compare_with_paper(database, study_id);
    }
    times.conclusions_s += wall_time_s() - start_s;
    start_s = wall_time_s();
    storage::finish_study(database, study_id, recommendations, paper);
    times.storage_s += wall_time_s() - start_s;
}

}  // namespace capstan
