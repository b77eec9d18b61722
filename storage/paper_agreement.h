#pragma once

#include <cstdio>
#include <string>

namespace capstan::storage {

// When a number of ours agrees with the paper's, for those who compare them and those who show the result.

// The paper rounds to 0.01 N, and reads some numbers off single draws of its own.
inline constexpr double paper_agreement_N = 0.03;
inline constexpr double paper_agreement_standard_errors = 2.0;

inline std::string paper_agreement_words() {
    char text[400];
    std::snprintf(
        text, sizeof text,
        "A row agrees where ours is within %g N (the paper's rounding and single draws) plus %g of our standard "
        "errors of the paper's number; with a bound, where ours is at most %g standard errors above it.",
        paper_agreement_N, paper_agreement_standard_errors, paper_agreement_standard_errors);
    return text;
}

// The configuration of the paper's experiment was partly fitted to its figures.
inline constexpr const char* paper_matched_words =
    "The instants, the reading of Table I's stiffness and the rule that an estimate may not move the blocked end were "
    "chosen by matching the paper's figures, so agreement is partly fitted. A reason is shown by an ablation, which "
    "`capstan paper estimation` prints, or is a guess.";

}  // namespace capstan::storage
