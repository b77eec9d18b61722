#pragma once

#include <string>
#include <vector>

#include "capstan/plan/study_plan.h"
#include "capstan/storage/diagnosis_records.h"

namespace capstan {

/// What a diagnosis found, as the truth that worlds lie about: the fitted nominal numbers, and the causes
/// that are of the cable with the probability that they are present (the smallest of theirs). Where intervals
/// are stored, the worlds are drawn from them: in a world with a cause its numbers, and in every world that
/// is as the diagnosis says the nominal numbers, in place of what [uncertainty] states of them. An effect of
/// one cable of a pair stays on that cable where the study's arrangement is a pair too.
struct DiagnosedWorld {
    TrueCable truth;
    double probability = 1.0;
    std::vector<std::string> left_out;  ///< causes of other parts of a bench
};
DiagnosedWorld world_of(const storage::DiagnosisRecord& diagnosis,
                        CableArrangement arrangement = CableArrangement::single);

}  // namespace capstan
