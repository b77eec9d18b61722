#include "capstan/residual_law/residual_law.h"

#include <algorithm>
#include <cmath>

#include "capstan/calibration/least_squares.h"
#include "capstan/platform/statistics.h"
#include "capstan/residual_law/law_search.h"
#include "capstan/residual_law/law_words.h"

namespace capstan::residual_law {

namespace {

// Neighbouring samples say the same: no more rows than this are fitted.
constexpr std::size_t fitted_samples = 6000;
// A choice is repeated without each part where enough others are left to repeat it on.
constexpr std::size_t min_nested_parts = 4;
// The only run is left out in parts.
constexpr std::size_t blocks_of_a_run = 4;

/// A part of the data that is left out at once.
struct Part {
    Eigen::MatrixXd columns;   // samples x columns
    Eigen::VectorXd residual;  // samples
    NormalEquations normal;
};

// How much each run counts when it is left out. A run whose load lies outside those of the others would test
// an extrapolation, in which a friction and its growth with the load are one: it counts less by its distance
// from them, in parts of the range of all. Of two runs each lies outside the other.
std::vector<double> importance_of(std::span<const ResidualRun> runs) {
    std::vector<double> importance(runs.size(), 1.0);
    if (runs.size() < 3 || runs.front().load.empty()) return importance;
    std::vector<double> loads;
    for (const ResidualRun& run : runs) loads.push_back(mean_of(run.load));
    const auto [least, largest] = std::minmax_element(loads.begin(), loads.end());
    if (!(*largest > *least)) return importance;
    for (std::size_t k = 0; k < loads.size(); ++k) {
        std::vector<double> others = loads;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
        const auto [low, high] = std::minmax_element(others.begin(), others.end());
        const double outside = std::max({0.0, *low - loads[k], loads[k] - *high});
        importance[k] = 1.0 - outside / (*largest - *least);
    }
    return importance;
}

std::vector<Part> parts_of(std::span<const ResidualRun> runs, const ColumnLibrary& library,
                           const FeatureScales& scales) {
    std::size_t scored = 0;
    for (const ResidualRun& run : runs) scored += run.motion.size() - run.first_scored;
    const std::size_t stride = std::max<std::size_t>(1, scored / fitted_samples);
    const std::vector<double> importance = importance_of(runs);
    std::vector<Part> parts;
    for (std::size_t k = 0; k < runs.size(); ++k) {
        const ResidualRun& run = runs[k];
        const Eigen::MatrixXd columns = columns_of(library, scales, run, stride);
        Eigen::VectorXd residual(columns.rows());
        for (Eigen::Index row = 0; row < residual.size(); ++row)
            residual[row] = run.residual[run.first_scored + static_cast<std::size_t>(row) * stride];
        const auto blocks = static_cast<Eigen::Index>(runs.size() == 1 ? blocks_of_a_run : 1);
        for (Eigen::Index block = 0; block < blocks; ++block) {
            const Eigen::Index first = residual.size() * block / blocks;
            const Eigen::Index rows = residual.size() * (block + 1) / blocks - first;
            if (rows == 0) continue;
            Part part{columns.middleRows(first, rows), residual.segment(first, rows), {}};
            part.normal = normal_equations(part.columns, part.residual);
            part.normal.importance = importance[k];
            parts.push_back(std::move(part));
        }
    }
    return parts;
}

PartedData parted(const std::vector<Part>& parts) {
    std::vector<NormalEquations> normals;
    for (const Part& part : parts) normals.push_back(part.normal);
    return in_parts(std::move(normals));
}

// Mean square of each part before, and with the law that is found without it.
struct NestedErrors {
    std::vector<double> before;
    std::vector<double> after;
    std::vector<double> importance;

    // Without part `left_out`; none: of all.
    double removed(std::optional<std::size_t> left_out = {}) const {
        double sum_before = 0.0;
        double sum_after = 0.0;
        for (std::size_t k = 0; k < before.size(); ++k) {
            if (k == left_out) continue;
            sum_before += importance[k] * before[k];
            sum_after += importance[k] * after[k];
        }
        return sum_before > 0.0 ? 1.0 - sum_after / sum_before : 0.0;
    }
};

/// A law of one form, and how it did where its choice was repeated without each part.
struct TriedLaw {
    FoundLaw found;
    NestedErrors errors;
};

TriedLaw tried_law(const ColumnLibrary& library, const PartedData& data, LawForm form) {
    TriedLaw tried{search_law(library, data, form), {}};
    for (const NormalEquations& part : data.parts) {
        tried.errors.before.push_back(part.target_square);
        tried.errors.importance.push_back(part.importance);
    }
    // The history's only choice is its ridge, which is not worth repeating.
    if (form == LawForm::history || data.parts.size() < min_nested_parts) {
        tried.errors.after = left_out_errors(data, chosen_columns(library, tried.found)).squares;
        return tried;
    }
    for (std::size_t k = 0; k < data.parts.size(); ++k) {
        std::vector<NormalEquations> others = data.parts;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
        const PartedData inner = in_parts(std::move(others));
        const ChosenColumns chosen = chosen_columns(library, search_law(library, inner, form));
        tried.errors.after.push_back(mean_square(data.parts[k], chosen, fitted_weights(inner.all, chosen)));
    }
    return tried;
}

// The number of parts, as they count.
double counting_parts(const PartedData& data) {
    double sum = 0.0;
    for (const NormalEquations& part : data.parts) sum += part.importance;
    return sum;
}

// Few terms, if they remove nearly as much as the best form does. Terms that remove less than half of what
// the motion's history does are not what is behind the residual, and are not stated.
TriedLaw best_law(const ColumnLibrary& library, const PartedData& data) {
    constexpr double nearly = 0.02;
    // Of two parts many a choice fits both by chance.
    const double worth_stating = counting_parts(data) < 3.0 ? 0.25 : 0.1;
    const auto removed_by = [](const TriedLaw& law) {
        return law.found.empty() ? 0.0 : law.errors.removed();
    };
    const TriedLaw history = tried_law(library, data, LawForm::history);
    TriedLaw best = tried_law(library, data, LawForm::terms);
    if (removed_by(best) < 0.5 * removed_by(history)) best = {};
    if (!best.found.empty()) {
        TriedLaw both = tried_law(library, data, LawForm::terms_and_history);
        if (removed_by(both) > removed_by(best) + nearly) best = std::move(both);
    }
    if (removed_by(history) > removed_by(best) + nearly) best = history;
    return removed_by(best) > worth_stating ? best : TriedLaw{};
}

void state_removed_fraction(ResidualLaw& law, const NestedErrors& errors) {
    law.removed_fraction = errors.removed();
    if (errors.before.size() < 3) return;
    std::vector<Eigen::VectorXd> without;
    for (std::size_t k = 0; k < errors.before.size(); ++k)
        without.push_back(Eigen::VectorXd::Constant(1, errors.removed(k)));
    const double half_width = gap::jackknife_half_widths(without, 1)[0];
    law.removed_low = law.removed_fraction - half_width;
    law.removed_high = std::min(1.0, law.removed_fraction + half_width);
}

// The magnitude that 95% of the residuals do not exceed, each with the weights that the other parts give.
double band_of(const std::vector<Part>& parts, const ChosenColumns& chosen, const LeftOutErrors& left_out) {
    constexpr double counts_enough = 0.5;
    std::vector<double> magnitudes;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        if (parts[k].normal.importance < counts_enough) continue;
        Eigen::VectorXd rest = parts[k].residual;
        if (!chosen.columns.empty())
            rest -= parts[k].columns(Eigen::all, chosen.columns) * left_out.weights[k];
        for (const double value : rest) magnitudes.push_back(std::abs(value));
    }
    constexpr double quantile = 0.95;
    const auto at = magnitudes.begin() +
                    static_cast<std::ptrdiff_t>(quantile * static_cast<double>(magnitudes.size() - 1));
    std::nth_element(magnitudes.begin(), at, magnitudes.end());
    return *at;
}

// The terms with their sizes. A wave's is its amplitude.
std::vector<LawTerm> sized_terms(const ColumnLibrary& library, const FoundLaw& found,
                                 const Eigen::VectorXd& weights, const LeftOutErrors& left_out) {
    std::vector<LawTerm> terms;
    Eigen::Index column = 0;
    for (const std::size_t term : found.terms) {
        LawTerm sized;
        const auto columns = static_cast<Eigen::Index>(library.terms[term].size());
        for (const Eigen::Index each : library.terms[term])
            sized.features.push_back(library.features[static_cast<std::size_t>(each)]);
        const auto size_of = [&](const Eigen::VectorXd& all) {
            return columns == 1 ? all[column] : all.segment(column, columns).norm();
        };
        sized.size = size_of(weights);
        std::vector<Eigen::VectorXd> without;
        for (const Eigen::VectorXd& each : left_out.weights)
            without.push_back(Eigen::VectorXd::Constant(1, size_of(each)));
        sized.half_width = gap::jackknife_half_widths(without, 1)[0];
        terms.push_back(std::move(sized));
        column += columns;
    }
    return terms;
}

}  // namespace

std::vector<double> ResidualLaw::predict(const ResidualRun& run) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(run.motion.size()));
    for (const WeightedFeature& each : weights) sum += each.weight * column_of(each.feature, scales, run);
    return {sum.begin(), sum.end()};
}

ResidualLaw fit_residual_law(std::span<const ResidualRun> given, const ResidualNames& names) {
    std::vector<ResidualRun> runs;
    for (const ResidualRun& run : given)
        if (run.first_scored < run.motion.size()) runs.push_back(run);
    ResidualLaw law;
    if (runs.empty()) return law;
    law.scales = scales_of(runs);
    const ColumnLibrary library = column_library(law.scales);
    const std::vector<Part> parts = parts_of(runs, library, law.scales);
    if (parts.size() < 2) return law;
    const PartedData data = parted(parts);
    const TriedLaw best = best_law(library, data);
    const FoundLaw& found = best.found;
    if (!found.empty()) state_removed_fraction(law, best.errors);
    const ChosenColumns chosen = chosen_columns(library, found);
    const Eigen::VectorXd weights = fitted_weights(data.all, chosen);
    const LeftOutErrors left_out = left_out_errors(data, chosen);
    for (std::size_t k = 0; k < chosen.columns.size(); ++k)
        law.weights.push_back({library.features[static_cast<std::size_t>(chosen.columns[k])],
                               weights[static_cast<Eigen::Index>(k)]});
    law.has_history_model = found.history_ridge.has_value();
    law.terms = sized_terms(library, found, weights, left_out);
    for (LawTerm& term : law.terms) term.words = term_words(term, law.scales, names);
    double squares = 0.0;
    for (const NormalEquations& part : data.parts) squares += part.target_square;
    law.residual_rms = std::sqrt(squares / static_cast<double>(data.parts.size()));
    law.left_out_rms = std::sqrt(left_out.mean());
    law.band = band_of(parts, chosen, left_out);
    return law;
}

}  // namespace capstan::residual_law
