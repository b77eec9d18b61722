#pragma once

#include <optional>
#include <vector>

#include "capstan/residual_law/left_out_errors.h"
#include "capstan/residual_law/residual_features.h"

namespace capstan::residual_law {

/// All columns that a law may use: every feature once.
struct ColumnLibrary {
    std::vector<Feature> features;                 // columns
    std::vector<std::vector<Eigen::Index>> terms;  // terms x their columns
    /// Terms that are tried together, because one of them may help only beside the others: zero, load and
    /// friction.
    std::vector<std::vector<std::size_t>> together;
    std::vector<Eigen::Index> history;  ///< the columns of the ridge regression
};

ColumnLibrary column_library(const FeatureScales& scales);

/// samples x columns; every `stride`th scored sample of a run.
Eigen::MatrixXd columns_of(const ColumnLibrary& library, const FeatureScales& scales, const ResidualRun& run,
                           std::size_t stride);

struct FoundLaw {
    std::vector<std::size_t> terms;         ///< in the library, in the order in which they were added
    std::optional<double> history_ridge{};  ///< of the ridge regression on the history, where it is added

    bool empty() const { return terms.empty() && !history_ridge; }
};

ChosenColumns chosen_columns(const ColumnLibrary& library, const FoundLaw& law);

/// What a law may be made of.
enum class LawForm {
    terms,              ///< a few terms
    history,            ///< a ridge regression on the motion's history
    terms_and_history,  ///< a few terms, and the ridge regression for what they leave
};

/// The law of a form that the error on parts left out asks for; empty if none helps clearly. At least two
/// parts.
FoundLaw search_law(const ColumnLibrary& library, const PartedData& data, LawForm form);

/// Whether the mean square falls by more than a few percent, and by more than twice the standard error of its
/// logarithm over the parts.
bool improves_clearly(const LeftOutErrors& before, const LeftOutErrors& after);

}  // namespace capstan::residual_law
