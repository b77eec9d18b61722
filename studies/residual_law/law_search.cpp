#include "capstan/residual_law/law_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace capstan::residual_law {

namespace {

constexpr std::size_t max_terms = 6;
// Where the runs do not distinguish two terms, as a zero and a gain on a load that changes little, both stay
// small. It makes a term that stands alone a hundredth too small.
constexpr double term_ridge = 0.01;
// What is added removes at least this fraction of the mean square that is left.
constexpr double min_removed = 0.03;
// And its logarithm falls by more than this many standard errors over the parts.
constexpr double clear_errors = 2.0;

bool same(const Feature& one, const Feature& other) {
    return one.kind == other.kind && one.parameter == other.parameter && one.times_load == other.times_load;
}

Eigen::Index column_in(ColumnLibrary& library, const Feature& feature) {
    for (std::size_t k = 0; k < library.features.size(); ++k)
        if (same(library.features[k], feature)) return static_cast<Eigen::Index>(k);
    library.features.push_back(feature);
    return static_cast<Eigen::Index>(library.features.size() - 1);
}

LeftOutErrors errors_of(const ColumnLibrary& library, const PartedData& data, const FoundLaw& law) {
    return left_out_errors(data, chosen_columns(library, law));
}

FoundLaw with_terms(FoundLaw law, const std::vector<std::size_t>& terms) {
    for (const std::size_t term : terms)
        if (std::find(law.terms.begin(), law.terms.end(), term) == law.terms.end()) law.terms.push_back(term);
    return law;
}

// A term whose work others have taken over, the least useful first.
void drop_needless_terms(const ColumnLibrary& library, const PartedData& data, FoundLaw& law) {
    while (!law.terms.empty()) {
        const LeftOutErrors now = errors_of(library, data, law);
        std::optional<std::size_t> needless;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < law.terms.size(); ++k) {
            FoundLaw without = law;
            without.terms.erase(without.terms.begin() + static_cast<std::ptrdiff_t>(k));
            const LeftOutErrors then = errors_of(library, data, without);
            if (then.mean() < least && !improves_clearly(then, now)) {
                least = then.mean();
                needless = k;
            }
        }
        if (!needless) return;
        law.terms.erase(law.terms.begin() + static_cast<std::ptrdiff_t>(*needless));
    }
}

// The term, or terms that belong together, that lower the error on left-out parts most; false if none does so
// clearly.
bool add_best_terms(const ColumnLibrary& library, const PartedData& data, FoundLaw& law) {
    const LeftOutErrors before = errors_of(library, data, law);
    std::vector<std::vector<std::size_t>> choices = library.together;
    for (std::size_t term = 0; term < library.terms.size(); ++term) choices.push_back({term});
    FoundLaw best = law;
    double least = before.mean();
    for (const std::vector<std::size_t>& choice : choices) {
        const FoundLaw tried = with_terms(law, choice);
        if (tried.terms.size() == law.terms.size()) continue;
        const LeftOutErrors after = errors_of(library, data, tried);
        if (after.mean() < least && improves_clearly(before, after)) {
            least = after.mean();
            best = tried;
        }
    }
    drop_needless_terms(library, data, best);
    if (!(errors_of(library, data, best).mean() < before.mean())) return false;
    law = best;
    return true;
}

FoundLaw with_history(const ColumnLibrary& library, const PartedData& data, const FoundLaw& law) {
    constexpr std::array ridges = {1.0, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-5};
    const LeftOutErrors before = errors_of(library, data, law);
    FoundLaw best = law;
    double least = before.mean();
    for (const double ridge : ridges) {
        FoundLaw tried = law;
        tried.history_ridge = ridge;
        const LeftOutErrors after = errors_of(library, data, tried);
        if (after.mean() < least && improves_clearly(before, after)) {
            least = after.mean();
            best = tried;
        }
    }
    return best;
}

}  // namespace

ColumnLibrary column_library(const FeatureScales& scales) {
    ColumnLibrary library;
    for (const Term& term : possible_terms(scales)) {
        library.terms.emplace_back();
        for (const Feature& feature : term) library.terms.back().push_back(column_in(library, feature));
    }
    const auto term_of = [&](const Feature& feature) {
        const std::vector<Eigen::Index> columns = {column_in(library, feature)};
        return static_cast<std::size_t>(std::find(library.terms.begin(), library.terms.end(), columns) -
                                        library.terms.begin());
    };
    for (const Term& together : terms_that_belong_together(scales)) {
        library.together.emplace_back();
        for (const Feature& feature : together) library.together.back().push_back(term_of(feature));
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
        for (const Eigen::Index column : library.terms[term]) chosen.add(column, term_ridge);
    if (!law.history_ridge) return chosen;
    for (const Eigen::Index column : library.history) {
        const bool is_free =
            std::find(chosen.columns.begin(), chosen.columns.end(), column) != chosen.columns.end();
        if (!is_free) chosen.add(column, *law.history_ridge);
    }
    return chosen;
}

// Relative to each part's own residual, so that the part with the largest does not decide alone.
bool improves_clearly(const LeftOutErrors& before, const LeftOutErrors& after) {
    if (!(after.mean() < (1.0 - min_removed) * before.mean())) return false;
    double importance = 0.0;
    double importance_squares = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t k = 0; k < before.squares.size(); ++k) {
        if (!(after.squares[k] > 0.0)) continue;
        const double fall = std::log(before.squares[k] / after.squares[k]);
        const double counts = before.importance[k];
        importance += counts;
        importance_squares += counts * counts;
        sum += counts * fall;
        squares += counts * fall * fall;
    }
    const double mean = sum / importance;
    const double parts = importance * importance / importance_squares;
    const double variance = std::max(0.0, squares / importance - mean * mean) / (parts - 1.0);
    return mean > clear_errors * std::sqrt(variance);
}

FoundLaw search_law(const ColumnLibrary& library, const PartedData& data, LawForm form) {
    FoundLaw law;
    if (form != LawForm::history)
        while (law.terms.size() < max_terms && add_best_terms(library, data, law)) {
        }
    return form == LawForm::terms ? law : with_history(library, data, law);
}

}  // namespace capstan::residual_law
