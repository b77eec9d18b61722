#include "capstan/residual_law/law_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace capstan::residual_law {

namespace {

constexpr std::size_t max_terms = 6;
// What is added removes at least this fraction of the mean square that is left.
constexpr double min_removed = 0.03;
// And its logarithm falls by more than this many standard errors over the parts.
constexpr double clear_errors = 2.0;

// Relative to each part's own residual, so that the part with the largest does not decide alone.
bool improves_clearly(const LeftOutErrors& before, const LeftOutErrors& after) {
    if (!(after.mean() < (1.0 - min_removed) * before.mean())) return false;
    const auto parts = static_cast<double>(before.squares.size());
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t k = 0; k < before.squares.size(); ++k) {
        if (!(after.squares[k] > 0.0)) continue;
        const double fall = std::log(before.squares[k] / after.squares[k]);
        sum += fall;
        squares += fall * fall;
    }
    const double mean = sum / parts;
    const double variance = std::max(0.0, squares / parts - mean * mean) / (parts - 1.0);
    return mean > clear_errors * std::sqrt(variance);
}

bool same(const Feature& one, const Feature& other) {
    return one.kind == other.kind && one.parameter == other.parameter && one.times_load == other.times_load;
}

Eigen::Index column_in(ColumnLibrary& library, const Feature& feature) {
    for (std::size_t k = 0; k < library.features.size(); ++k)
        if (same(library.features[k], feature)) return static_cast<Eigen::Index>(k);
    library.features.push_back(feature);
    return static_cast<Eigen::Index>(library.features.size() - 1);
}

LeftOutErrors errors_of(const ColumnLibrary& library, const std::vector<NormalEquations>& parts,
                        const FoundLaw& law) {
    return left_out_errors(parts, chosen_columns(library, law));
}

// The term that lowers the error on left-out parts most; false if none does so clearly.
bool add_best_term(const ColumnLibrary& library, const std::vector<NormalEquations>& parts, FoundLaw& law) {
    const LeftOutErrors before = errors_of(library, parts, law);
    std::optional<std::size_t> best;
    double least = before.mean();
    for (std::size_t term = 0; term < library.terms.size(); ++term) {
        if (std::find(law.terms.begin(), law.terms.end(), term) != law.terms.end()) continue;
        FoundLaw tried = law;
        tried.terms.push_back(term);
        const LeftOutErrors after = errors_of(library, parts, tried);
        if (after.mean() < least && improves_clearly(before, after)) {
            least = after.mean();
            best = term;
        }
    }
    if (!best) return false;
    law.terms.push_back(*best);
    return true;
}

// A term whose work later terms have taken over.
void drop_needless_terms(const ColumnLibrary& library, const std::vector<NormalEquations>& parts,
                         FoundLaw& law) {
    for (std::size_t k = law.terms.size(); k-- > 0;) {
        FoundLaw without = law;
        without.terms.erase(without.terms.begin() + static_cast<std::ptrdiff_t>(k));
        if (!improves_clearly(errors_of(library, parts, without), errors_of(library, parts, law)))
            law = without;
    }
}

}  // namespace

ColumnLibrary column_library(const FeatureScales& scales) {
    ColumnLibrary library;
    for (const Term& term : possible_terms(scales)) {
        library.terms.emplace_back();
        for (const Feature& feature : term) library.terms.back().push_back(column_in(library, feature));
    }
    for (const Feature& feature : history_features(scales))
        library.history.push_back(column_in(library, feature));
    return library;
}

Eigen::MatrixXd columns_of(const ColumnLibrary& library, const FeatureScales& scales, const ResidualRun& run,
                           std::size_t stride) {
    const std::size_t scored = run.motion.size() - run.first_scored;
    Eigen::MatrixXd columns(static_cast<Eigen::Index>((scored + stride - 1) / stride),
                            static_cast<Eigen::Index>(library.features.size()));
    for (std::size_t k = 0; k < library.features.size(); ++k) {
        const Eigen::VectorXd all = column_of(library.features[k], scales, run);
        for (Eigen::Index row = 0; row < columns.rows(); ++row)
            columns(row, static_cast<Eigen::Index>(k)) =
                all[static_cast<Eigen::Index>(run.first_scored + static_cast<std::size_t>(row) * stride)];
    }
    return columns;
}

ChosenColumns chosen_columns(const ColumnLibrary& library, const FoundLaw& law) {
    ChosenColumns chosen;
    for (const std::size_t term : law.terms)
        for (const Eigen::Index column : library.terms[term]) chosen.add(column, 0.0);
    if (!law.history_ridge) return chosen;
    for (const Eigen::Index column : library.history) {
        const bool is_free =
            std::find(chosen.columns.begin(), chosen.columns.end(), column) != chosen.columns.end();
        if (!is_free) chosen.add(column, *law.history_ridge);
    }
    return chosen;
}

FoundLaw search_law(const ColumnLibrary& library, const std::vector<NormalEquations>& parts) {
    constexpr std::array ridges = {1.0, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5};
    FoundLaw law;
    while (law.terms.size() < max_terms && add_best_term(library, parts, law)) {
    }
    drop_needless_terms(library, parts, law);
    FoundLaw best = law;
    for (const double ridge : ridges) {
        FoundLaw tried = law;
        tried.history_ridge = ridge;
        if (errors_of(library, parts, tried).mean() < errors_of(library, parts, best).mean()) best = tried;
    }
    const bool helps = best.history_ridge &&
                       improves_clearly(errors_of(library, parts, law), errors_of(library, parts, best));
    return helps ? best : law;
}

}  // namespace capstan::residual_law
