// What becomes of a set of causes that was built up one by one: it is refined, fitted to every sample,
// weighed by what it leaves, and judged on runs that its fit did not see.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "capstan/effects/known_causes.h"
#include "capstan/gap/cause_search.h"
#include "capstan/platform/parallel_for.h"

namespace capstan::gap {

namespace {

// Which of a ripple's numbers is that of its periods; none of another cause.
std::optional<Eigen::Index> periods_of(const CandidateCause& cause) {
    for (std::size_t k = 0; k < cause.numbers.size(); ++k) {
        if (cause.numbers[k].kind == OpenNumber::Kind::periods) return static_cast<Eigen::Index>(k);
    }
    return std::nullopt;
}

// The first ripple in a set.
struct Ripple {
    const CandidateCause* cause = nullptr;
    Eigen::Index first = 0;  // of its numbers among the coordinates
    Eigen::Index periods = 0;
};

Ripple ripple_of(const Hypothesis& set) {
    Eigen::Index first = set.bench->size();
    for (const CandidateCause* cause : set.causes) {
        if (const auto periods = periods_of(*cause)) return {cause, first, first + *periods};
        first += static_cast<Eigen::Index>(cause->numbers.size());
    }
    return {};
}

// Of so few periods that it is no ripple, but any function of the position.
bool has_too_slow_a_ripple(const Hypothesis& set) {
    const Ripple ripple = ripple_of(set);
    if (ripple.cause == nullptr) return false;
    const OpenNumber& number = ripple.cause->numbers[static_cast<std::size_t>(ripple.periods - ripple.first)];
    return number.value(set.coordinates[ripple.periods]) <= number.low;
}

// Those of the bench's own numbers beyond the first three that are far from usual are as usual again: they
// may have stood for a cause that is still to be found.
Hypothesis with_usual_numbers(Hypothesis hypothesis) {
    for (Eigen::Index k = nominal_coordinates; k < hypothesis.bench->size(); ++k) {
        const FloatingNumber& number = hypothesis.bench->numbers[static_cast<std::size_t>(k)];
        if (std::abs(hypothesis.coordinates[k]) > number.prior_std) hypothesis.coordinates[k] = 0.0;
    }
    return hypothesis;
}

// The sets with one cause fewer than the best of these fits, and than those that are `behind` it at most, of
// which there is no fit.
std::vector<Hypothesis> smaller_sets_not_fitted(const std::vector<ScoredFit>& fits, double behind) {
    std::vector<Hypothesis> missing;
    for (const ScoredFit& each : fits) {
        if (each.evidence < fits.front().evidence - behind) break;
        if (!each.may_follow_model_error() || each.fit.causes.size() < 2) continue;
        for (Hypothesis& set : without_each(each.fit.hypothesis())) {
            const auto is_same = [&](const Hypothesis& other) {
                return other.bench == set.bench && are_same_causes(other.causes, set.causes);
            };
            if (fit_of(fits, set.causes, set.bench) == nullptr &&
                std::none_of(missing.begin(), missing.end(), is_same))
                missing.push_back(std::move(set));
        }
    }
    return missing;
}

// Those without a cause, whose misfit limits how visible one can be, and the best others: of several starts
// with the same causes the best. The best single cause is one of them, because another model may show that
// those beside it do nothing. A set that is `behind` the best one in evidence stays behind it.
std::vector<Hypothesis> best_sets(std::vector<ScoredFit> fits, std::size_t max_sets, double behind) {
    const double tenable = fits.front().evidence - behind;
    std::stable_partition(fits.begin(), fits.end(),
                          [](const ScoredFit& fit) { return is_nothing(fit.fit.causes); });
    std::vector<Hypothesis> best;
    bool has_single = false;
    for (auto each = fits.begin(); each != fits.end(); ++each) {
        const bool has_no_cause = is_nothing(each->fit.causes);
        const bool is_single = each->fit.causes.size() == 1 && !has_no_cause;
        const bool is_needed = has_no_cause || (is_single && !has_single);
        if (!is_needed && (best.size() >= max_sets || each->evidence < tenable)) continue;
        has_single |= is_single;
        if (fit_of(fits, each->fit.causes) == &*each) best.push_back(each->fit.hypothesis());
    }
    return best;
}

}  // namespace

// The best sets, from where another model led them. Out of time the best one is still fitted.
CauseSearch::Fits CauseSearch::fitted_again(Model& model, const Fits& fits, std::size_t max_sets) {
    constexpr std::size_t at_least = 2;  // without a cause, and the best
    // The means of blocks are sharper, so that the coarse model's error changes the evidence more; from the
    // draft to the coarse model it changes more than that.
    const double behind = 10.0 * sharpness();
    const std::vector<Hypothesis> best =
        best_sets(fits, max_sets, &model == &fine_ ? behind : std::numeric_limits<double>::infinity());
    report("fitting the best explanations again");
    CauseFitter::FitOptions options;
    options.any_size = false;
    options.balanced = true;
    options.is_close = &model == &fine_ && !is_undescribed(*fits.front().fit.bench);
    Fits again = made_side_by_side(
        model, best.size(), [&](std::size_t k) { return model.fitter.fit(best[k], options); }, at_least);
    sort_by_evidence(again);
    return again;
}

// The best set without each of its causes, where the fine model has not seen that. The coarse model skips
// samples, except where an inertia rings, so that a little inertia may stand for what the others miss.
void CauseSearch::try_fewer_finely(Fits& all) {
    while (all.front().fit.causes.size() > 1 && !is_out_of_time()) {
        const double before = all.front().evidence;
        std::vector<Hypothesis> fewer = without_each(all.front().fit.hypothesis());
        std::erase_if(fewer, [&](const Hypothesis& set) { return fit_of(all, set.causes) != nullptr; });
        add_fitted_finely(fewer, all);
        if (all.front().evidence == before) return;
    }
}

// On a bench of unknown geometry a set that was built up cause by cause may hold one that stands for
// another, and so may a number of the bench.
void CauseSearch::refine(const Level& level, Fits& all) {
    constexpr int max_rounds = 2;
    Hypothesis swapped;
    if (recording_.is_undescribed_drive()) try_ripple_or_torque(level, all);
    for (int round = 0; round < max_rounds && !is_out_of_time(); ++round) {
        const double before = all.front().evidence;
        try_usual_numbers(level, all);
        try_swapping(level, swapped, all);
        if (all.front().evidence < before + clear_gain) return;
    }
}

// A smooth torque over the position may stand for a part of a ripple, beside another one of the wrong period
// or alone, and a ripple of which less than a period was seen for a smooth torque. Each is tried in the place
// of the other.
void CauseSearch::try_ripple_or_torque(const Level& level, Fits& all) {
    const auto ripple =
        std::find_if(level.causes.begin(), level.causes.end(),
                     [](const CandidateCause& cause) { return periods_of(cause).has_value(); });
    if (ripple == level.causes.end()) return;
    const std::vector<std::string> confused = confusable_causes(ripple->effect);
    const auto is_smooth = [&](const CandidateCause& cause) {
        return std::find(confused.begin(), confused.end(), cause.effect) != confused.end();
    };
    const CauseFit best = all.front().fit;
    const auto& causes = best.causes;
    if (std::any_of(causes.begin(), causes.end(),
                    [&](const CandidateCause* each) { return is_smooth(*each); })) {
        Fits sets = fitted_instead(level, best, *ripple, is_smooth);
        try_periods(level, sets);
        std::erase_if(sets,
                      [](const ScoredFit& each) { return has_too_slow_a_ripple(each.fit.hypothesis()); });
        std::move(sets.begin(), sets.end(), std::back_inserter(all));
    } else if (has_too_slow_a_ripple(best.hypothesis())) {
        const auto smooth = std::find_if(level.causes.begin(), level.causes.end(), is_smooth);
        if (smooth == level.causes.end()) return;
        Fits sets = fitted_instead(level, best, *smooth,
                                   [&](const CandidateCause& cause) { return &cause == &*ripple; });
        std::move(sets.begin(), sets.end(), std::back_inserter(all));
    }
    sort_by_evidence(all);
}

// With a cause in the place of those that it replaces.
CauseSearch::Fits CauseSearch::fitted_instead(const Level& level, const CauseFit& fit,
                                              const CandidateCause& cause,
                                              const std::function<bool(const CandidateCause&)>& replaces) {
    Fits sets;
    if (is_out_of_time()) return sets;
    Hypothesis instead =
        only_causes(fit.hypothesis(), [&](const CandidateCause& each) { return !replaces(each); });
    if (std::find(instead.causes.begin(), instead.causes.end(), &cause) == instead.causes.end())
        instead =
            with_cause(instead, &cause,
                       screen_each_start(rough_model().fitter, cause, instead, fit.weights).front().start);
    report("fitting " + in_words(instead.causes));
    add_fits(level, {instead}, false, sets);
    return sets;
}

// Further causes beside the best set, beside usual numbers of the bench.
void CauseSearch::try_usual_numbers(const Level& level, Fits& all) {
    const CauseFit best = all.front().fit;
    const Hypothesis usual = with_usual_numbers(best.hypothesis());
    if (is_nothing(best.causes) || usual.coordinates == best.coordinates) return;
    Fits sets;
    add_sets(level, usual, best.weights, max_fitted_further, sets);
    std::move(sets.begin(), sets.end(), std::back_inserter(all));
    sort_by_evidence(all);
}

// The best set with one cause more than the best of all, without each of its causes in turn: the one that was
// added may do what another one stood for. `swapped`: the last set that this was done to.
void CauseSearch::try_swapping(const Level& level, Hypothesis& swapped, Fits& all) {
    for (;;) {
        const double before = all.front().evidence;
        const std::size_t more = all.front().fit.causes.size() + 1;
        const auto larger = std::find_if(all.begin(), all.end(), [&](const ScoredFit& each) {
            return each.fit.bench == &level.bench && each.fit.causes.size() == more;
        });
        if (larger == all.end() || more == 2 || more > max_causes) return;
        const Hypothesis set = larger->fit.hypothesis();
        if (set.causes == swapped.causes && set.coordinates == swapped.coordinates) return;
        swapped = set;
        report("trying fewer causes");
        add_fits(level, without_each(set), false, all);
        sort_by_evidence(all);
        if (all.front().evidence < before + clear_gain) return;
        const Fits best = {all.front()};
        Fits sets = larger_sets(level, best);
        std::move(sets.begin(), sets.end(), std::back_inserter(all));
        sort_by_evidence(all);
    }
}

bool CauseSearch::has_ripple(const ScoredFit& fit) {
    return ripple_of(fit.fit.hypothesis()).cause != nullptr;
}

// A ripple was screened beside numbers of the bench that had made up for it. With them free, another number
// of periods may be better: of the best set that has a ripple, the most promising numbers are fitted, and
// then their neighbours.
void CauseSearch::try_periods(const Level& level, Fits& sets) {
    constexpr std::size_t max_rough = 8;
    constexpr std::size_t max_fitted_periods = 3;
    // By another number of periods. Beside the numbers of a described bench a ripple that matters leads.
    const double max_gain = is_undescribed(level.bench) ? 30.0 : 0.0;
    const auto found = std::find_if(sets.begin(), sets.end(), [&](const ScoredFit& each) {
        return each.evidence >= sets.front().evidence - max_gain &&
               ripple_of(each.fit.hypothesis()).cause != nullptr;
    });
    if (found == sets.end()) return;
    report("trying other numbers of periods");
    ScoredFit best = *found;
    const Hypothesis set = best.fit.hypothesis();
    const Ripple ripple = ripple_of(set);
    const auto count = static_cast<Eigen::Index>(ripple.cause->numbers.size());
    const OpenNumber& number = ripple.cause->numbers[static_cast<std::size_t>(ripple.periods - ripple.first)];
    std::vector<double> tried = {number.value(set.coordinates[ripple.periods])};
    const auto is_tried = [&](double periods) {
        return std::find(tried.begin(), tried.end(), periods) != tried.end();
    };

    std::vector<Further> promising;
    const Hypothesis without =
        only_causes(set, [&](const CandidateCause& cause) { return &cause != ripple.cause; });
    for (const Screened& each :
         screen_each_start(rough_model().fitter, *ripple.cause, without, best.fit.weights)) {
        if (promising.size() == max_rough) break;
        Hypothesis other = set;
        other.coordinates.segment(ripple.first, count) = each.start;
        if (!is_tried(number.value(other.coordinates[ripple.periods])))
            promising.push_back({ripple.cause, std::move(other), each.sum_of_squares});
    }
    // A harmonic may have stood for the ripple, or the ripple for a harmonic.
    const double found_periods = tried.front();
    for (const double periods :
         {found_periods / 3.0, found_periods / 2.0, 2.0 * found_periods, 3.0 * found_periods}) {
        const auto is_promising = [&](const Further& each) {
            return number.value(each.start.coordinates[ripple.periods]) == periods;
        };
        if (number.value(periods) != periods || std::any_of(promising.begin(), promising.end(), is_promising))
            continue;
        Hypothesis other = set;
        other.coordinates[ripple.periods] = periods;
        promising.push_back({ripple.cause, std::move(other), 0.0});
    }
    fit_roughly(promising, best.fit.weights, {});

    const auto fit_each = [&](const std::vector<Hypothesis>& starts) {
        for (const Hypothesis& each : starts) tried.push_back(number.value(each.coordinates[ripple.periods]));
        const std::size_t known = sets.size();
        if (!starts.empty()) add_fits(level, starts, false, sets);
        for (std::size_t k = known; k < sets.size(); ++k) {
            if (sets[k].evidence > best.evidence) best = sets[k];
        }
    };
    std::vector<Hypothesis> starts;
    for (std::size_t k = 0; k < std::min(max_fitted_periods, promising.size()); ++k)
        starts.push_back(promising[k].start);
    fit_each(starts);
    for (bool climbs = true; climbs && !is_out_of_time();) {
        const double middle = number.value(best.fit.coordinates[ripple.periods]);
        std::vector<Hypothesis> neighbours;
        for (const double periods : {middle - 1.0, middle + 1.0}) {
            if (number.value(periods) != periods || is_tried(periods)) continue;
            neighbours.push_back(best.fit.hypothesis());
            neighbours.back().coordinates[ripple.periods] = periods;
        }
        fit_each(neighbours);
        climbs = number.value(best.fit.coordinates[ripple.periods]) != middle;
    }
    sort_by_evidence(sets);
}

// What the best fit leaves may be little more than noise, whose samples are independent. Whether it says more
// than was thought.
bool CauseSearch::take_correlation_of(const ScoredFit& best) {
    const double before = fine_.fitter.independent_samples();
    const auto times_s = coarse_.fitter.correlation_times_s(best.fit.residuals);
    for (Model* model : {&fine_, &coarse_}) {
        model->fitter.set_correlation_times(times_s);
        model->discrepancy.set_samples(
            [&](std::size_t channel) { return model->fitter.independent_samples(channel); });
    }
    evidence_.set_samples(fine_.fitter.independent_samples());
    return fine_.fitter.independent_samples() > before;
}

// As long as the usual correlation is assumed, it stands for what laws are wrong by.
Marginals CauseSearch::beside_own_scales(const Model& model, const CauseFit& fit) const {
    std::vector<double> of_laws;
    if (is_sharper_ && !model.left_of_channels.empty()) {
        of_laws = model.fitter.channel_misfits(fit);
        std::transform(of_laws.begin(), of_laws.end(), model.left_of_channels.begin(), of_laws.begin(),
                       [](double left, double without_cause) {
                           return law_error * law_error * std::max(0.0, without_cause - left);
                       });
    }
    return model.discrepancy.with_own_scales(fit.residuals, of_laws);
}

// The logarithm of the mean square residual of each part with the numbers fitted to the rest, averaged over
// the parts: one part that is far from all others does not decide.
double CauseSearch::held_out_log_misfit(const Hypothesis& hypothesis, const SeriesWeights& weights,
                                        const std::vector<LeftOut>& parts) {
    const CauseFitter& fitter = coarse_.fitter;
    CauseFitter::FitOptions options;
    options.any_size = false;
    options.weights = weights;
    const CauseFit all = fitter.fit(hypothesis, options);
    std::vector<Hypothesis> without;
    for (const CauseFit& fit : fitter.fits_without(all, parts)) without.push_back(fit.hypothesis());
    Eigen::MatrixXd residuals = fitter.data_residuals(without);
    fitter.apply(weights, residuals);
    double sum = 0.0;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        double squares = 0.0;
        double rows = 0.0;
        for (const ResidualSeries& series : fitter.series()) {
            if (series.run != parts[part].run) continue;
            const auto [from, to] = parts[part].rows(series.rows);
            rows += static_cast<double>(series.determined_rows(from, to));
            squares += residuals
                           .block(static_cast<Eigen::Index>(series.first_row + from),
                                  static_cast<Eigen::Index>(part), static_cast<Eigen::Index>(to - from), 1)
                           .squaredNorm();
        }
        sum += evidence_.log_of(squares / std::max(1.0, rows));
    }
    return sum / static_cast<double>(parts.size());
}

void CauseSearch::add_fitted_finely(const std::vector<Hypothesis>& starts, Fits& all) {
    report("trying fewer causes");
    CauseFitter::FitOptions options;
    options.any_size = false;
    options.balanced = true;
    options.is_close = true;
    Fits made = made_side_by_side(fine_, starts.size(),
                                  [&](std::size_t k) { return fine_.fitter.fit(starts[k], options); });
    std::move(made.begin(), made.end(), std::back_inserter(all));
    sort_by_evidence(all);
}

// What the set that leads in the end, and each of its rivals, leaves without one of its causes has to be
// known: E70 takes nothing from a set of which that is not.
void CauseSearch::charge_corrections(Fits& fits) {
    for (;;) {
        Fits charged = fits;
        for (ScoredFit& each : charged) each.charge_unproven(evidence_.penalty_of_corrections(each, fits));
        sort_by_evidence(charged);
        const std::vector<Hypothesis> fewer =
            is_out_of_time() ? std::vector<Hypothesis>() : smaller_sets_not_fitted(charged, rival_behind);
        if (fewer.empty()) {
            fits = std::move(charged);
            return;
        }
        add_fitted_finely(fewer, fits);
    }
}

// A cause that does not help to predict what the fit did not see may only have fitted the rest. It goes where
// the predictions lose more by it than the fit has gained. The set without it then goes before the set with
// it.
void CauseSearch::drop_unearned_causes(Fits& fits) {
    constexpr std::size_t enough_runs = 3;
    constexpr double unearned_penalty = 4.0;
    if (recording_.runs.size() < enough_runs) return;
    const double samples = fine_.fitter.independent_samples();
    while (fits.front().fit.causes.size() > 1 && !is_out_of_time()) {
        report("predicting each run from the others");
        const ScoredFit best = fits.front();
        const Hypothesis all = best.fit.hypothesis();
        const std::vector<LeftOut> parts = left_out_in_turn(recording_.runs.size(), all.causes);
        const double with_all = held_out_log_misfit(all, best.fit.weights, parts);
        const std::vector<Hypothesis> fewer = without_each(all);
        std::vector<double> lost(fewer.size());  // log likelihood, as the evidence is
        parallel_for_each_index(static_cast<int>(fewer.size()), options_.threads, [&](int index) {
            const auto k = static_cast<std::size_t>(index);
            lost[k] = 0.5 * samples * (with_all - held_out_log_misfit(fewer[k], best.fit.weights, parts));
        });
        std::optional<ScoredFit> earned;
        double max_lost = 0.0;
        for (std::size_t k = 0; k < fewer.size(); ++k) {
            if (lost[k] < max_lost) continue;
            CauseFitter::FitOptions options;
            options.any_size = false;
            options.weights = best.fit.weights;
            ScoredFit fit = scored(fine_, fine_.fitter.fit(fewer[k], options));
            if (best.evidence - fit.evidence > lost[k]) continue;
            max_lost = lost[k];
            earned = std::move(fit);
        }
        if (!earned) return;
        for (ScoredFit& each : fits) {
            const auto is_in = [&](const CandidateCause* cause) {
                return std::find(each.fit.causes.begin(), each.fit.causes.end(), cause) !=
                       each.fit.causes.end();
            };
            if (each.fit.bench == earned->fit.bench && each.fit.causes.size() > earned->fit.causes.size() &&
                std::all_of(earned->fit.causes.begin(), earned->fit.causes.end(), is_in))
                each.charge_unproven(std::max(0.0, each.evidence - (earned->evidence - unearned_penalty)));
        }
        fits.push_back(std::move(*earned));
        sort_by_evidence(fits);
    }
}

// Causes that are easily confused with one of the best set are fitted in its place whatever the screening
// says: of each the variants that it puts first. `screened`: causes beside the others of the set.
void CauseSearch::add_confusable(const Level& level, const CandidateCause& confused,
                                 const std::vector<Further>& screened, Fits& fits) {
    constexpr int max_variants = 3;
    const Hypothesis others = only_causes(fits.front().fit.hypothesis(),
                                          [&](const CandidateCause& cause) { return &cause != &confused; });
    for (const std::string& rival : confusable_causes(confused.effect)) {
        std::vector<Hypothesis> starts;
        int variants = 0;
        for (const Further& each : screened) {
            if (each.cause->effect != rival) continue;
            if (variants++ == max_variants) break;
            std::vector<const CandidateCause*> set = others.causes;
            set.push_back(each.cause);
            const bool is_known =
                std::any_of(others.causes.begin(), others.causes.end(),
                            [&](const CandidateCause* other) { return other->effect == rival; }) ||
                fit_of(fits, set) != nullptr;
            if (is_known) continue;
            const auto own = static_cast<Eigen::Index>(each.cause->numbers.size());
            starts.push_back(level.bench.is_measured()
                                 ? each.start
                                 : with_cause(others, each.cause, each.start.coordinates.tail(own)));
        }
        if (starts.empty()) continue;
        report("fitting " + in_words(starts.front().causes));
        add_fits(level, starts, level.bench.is_measured(), fits);
    }
}

// A set may hold a rival of a cause, which explains much the same beside the others.
void CauseSearch::try_confusable(const Level& level, Fits& all) {
    const CauseFit best = all.front().fit;
    if (best.causes.size() < 2 || best.bench != &level.bench || is_undescribed(level.bench)) return;
    for (const CandidateCause* cause : best.causes) {
        if (is_out_of_time()) break;
        const Hypothesis others =
            only_causes(best.hypothesis(), [&](const CandidateCause& other) { return &other != cause; });
        std::vector<Further> rivals;
        for (const Screened& each :
             screen(rough_model().fitter, level.causes, others, best.weights, &promising_starts()))
            rivals.push_back({each.cause, with_cause(others, each.cause, each.start), each.sum_of_squares});
        add_confusable(level, *cause, rivals, all);
    }
    sort(level, all);
}

}  // namespace capstan::gap
