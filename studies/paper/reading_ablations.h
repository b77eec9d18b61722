#pragma once

#include <string>
#include <vector>

#include "capstan/placement/study_run.h"
#include "capstan/storage/records.h"

namespace capstan::paper {

/// One reading of the paper's estimation experiment that is changed on purpose.
struct ReadingAblation {
    std::string name;
    std::string meaning;
    /// Rows of compare_placement() with the changed reading.
    std::vector<storage::PaperComparisonRecord> rows;
};

/// The paper's table as configured, and with each reading changed by itself. `plan` compares with the paper;
/// its studies are run one after the other in a temporary file.
struct AblatedTable {
    std::vector<storage::PaperComparisonRecord> as_configured;
    std::vector<ReadingAblation> ablations;
};

/// True if an ablation brings a row to the paper's number: it agrees, or lies on the other side of that
/// number.
bool accounts_for(const storage::PaperComparisonRecord& ablated,
                  const storage::PaperComparisonRecord& configured);

AblatedTable ablate_readings(const StudyPlan& plan, const RunOptions& options);

}  // namespace capstan::paper
