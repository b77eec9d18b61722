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
    std::vector<Eigen::Index> history;             ///< the columns of the ridge regression
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

/// Forward selection by the error on parts left out, then the ridge regression; at least two parts.
FoundLaw search_law(const ColumnLibrary& library, const std::vector<NormalEquations>& parts);

}  // namespace capstan::residual_law
