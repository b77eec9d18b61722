#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "capstan/effects/known_causes.h"
#include "capstan/gap/cause_search.h"
#include "capstan/platform/parallel_for.h"

namespace capstan::gap {

namespace {

// Where the bench's numbers float widely, they take up much of what a cause does, and the screening, which is
// linear, says less: beside the best set more causes are fitted than max_fitted_further.
constexpr std::size_t max_fitted_beside_the_best = 8;
// A mean square residual, in units of noise and floor.
constexpr double as_good_as_noise = 1.0;
// How many of the best sets of one size are extended.
constexpr std::size_t max_extended = 2;

// A wrong nominal number beside a cause that lets the same number go far already.
bool is_part_of(const CandidateCause& cause, const CandidateCause& first) {
    if (!cause.numbers.empty()) return false;
    for (Eigen::Index number = 0; number < nominal_coordinates; ++number) {
        if (cause.nominal_std(number) > nominal_log_std && first.nominal_std(number) > nominal_log_std)
            return true;
    }
    return false;
}

// The numbers of a cause that does what a number of the bench does at this coordinate.
Eigen::VectorXd as_size_of(const CandidateCause& cause, const FloatingNumber& number, double coordinate) {
    Eigen::VectorXd numbers = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cause.numbers.size()));
    numbers[0] = cause.numbers.front().coordinate_of_size(number.value(coordinate));
    return numbers;
}

std::vector<Hypothesis> without_each_of_closest_fit(const std::vector<ScoredFit>& fits) {
    const auto closest = std::min_element(
        fits.begin(), fits.end(), [](const ScoredFit& a, const ScoredFit& b) { return a.misfit < b.misfit; });
    if (closest == fits.begin() || closest->fit.causes.size() < 2) return {};
    return without_each(closest->fit.hypothesis());
}

// Sets without a cause that does nothing, best first, where such a set led further than the same without it.
std::vector<Hypothesis> without_idle_causes(const std::vector<ScoredFit>& fits) {
    constexpr double idle_visibility = 0.5;
    constexpr double leads_further = 0.8;  // of the mean square that the set without the cause leaves
    constexpr std::size_t max_sets = 4;
    std::vector<Hypothesis> sets;
    for (const ScoredFit& each : fits) {
        if (each.fit.bench != fits.front().fit.bench || each.fit.causes.size() < 2) continue;
        for (std::size_t k = 0; k < each.fit.causes.size() && sets.size() < max_sets; ++k) {
            if (each.visibility[k] >= idle_visibility) continue;
            Hypothesis fewer = only_causes(each.fit.hypothesis(), [&](const CandidateCause& cause) {
                return &cause != each.fit.causes[k];
            });
            const auto is_known = [&](const Hypothesis& set) {
                return are_same_causes(set.causes, fewer.causes);
            };
            const bool is_left_behind = std::none_of(fits.begin(), fits.end(), [&](const ScoredFit& other) {
                return other.fit.bench == each.fit.bench && is_known(other.fit.hypothesis()) &&
                       leads_further * other.misfit <= each.misfit;
            });
            if (is_left_behind && std::none_of(sets.begin(), sets.end(), is_known))
                sets.push_back(std::move(fewer));
        }
    }
    return sets;
}

}  // namespace

// Best first. On a bench as built the evidence of each set includes its penalty by E70, as far as its smaller
// sets are known, so that a set that only corrects the model is not extended.
void CauseSearch::sort(const Level& level, Fits& fits) const {
    if (&level == &built_) {
        std::vector<double> penalties;
        for (const ScoredFit& each : fits) penalties.push_back(evidence_.penalty_of_corrections(each, fits));
        for (std::size_t k = 0; k < fits.size(); ++k)
            fits[k].charge_unproven(penalties[k] - fits[k].unproven_penalty);
    }
    sort_by_evidence(fits);
}

void CauseSearch::search_several(const Level& level, Fits& all) {
    sort(level, all);
    Fits sets = all;
    for (std::size_t causes = 2; causes <= max_causes; ++causes) {
        if (draft_ && all.front().misfit < leads_nowhere) {
            end_draft(all);
            sets = all;
            if (causes > 2)
                std::erase_if(sets,
                              [&](const ScoredFit& fit) { return fit.fit.causes.size() + 1 != causes; });
        }
        sets = larger_sets(level, sets);
        if (sets.empty()) break;
        if (!level.bench.is_measured() && (is_undescribed(level.bench) || !has_ripple(all.front()) ||
                                           sets.front().misfit > as_good_as_noise))
            try_periods(level, sets);
        std::move(sets.begin(), sets.end(), std::back_inserter(all));
        sort(level, all);
        const auto has_this_size = [&](const ScoredFit& fit) { return fit.fit.causes.size() == causes; };
        if (!has_this_size(all.front())) break;
        sets.clear();
        std::copy_if(all.begin(), all.end(), std::back_inserter(sets), has_this_size);
    }
    if (draft_) end_draft(all);
    if (is_undescribed(level.bench)) refine(level, all);
    if (!is_undescribed(level.bench)) {
        try_without_idle_causes(level, all);
        if (!level.bench.is_measured()) try_from_smaller_sets(level, all);
    }
    // A band's tension falls by a factor round its drum, and a recording often has one run of it: a wider
    // search finds causes there that other runs do not confirm.
    for (bool changes = true; changes;) {
        const bool is_smaller = try_fewer(level, all);
        changes = recording_.is_undescribed_drive() &&
                  ((is_smaller && try_more(level, all)) || replace_the_weakest(level, all));
    }
    // The other causes are sought again beside all numbers of a bench as built.
    if (level.bench.is_measured() && has_several_and_a_usual_number(all.front())) return;
    if (try_last(level, all)) try_fewer(level, all);
    is_sharper_ = recording_.is_undescribed_drive() && take_correlation_of(all.front());
    if (is_sharper_) {
        all = fitted_again(coarse_, all, max_after_draft);
        try_fewer(level, all);
    }
    if (!level.bench.is_measured()) {
        try_others(level, all);
        try_faults_of_the_bench(level, all);
    }
    try_confusable(level, all);
    // In the place of its rival a cause may make another one of the set superfluous.
    if (!level.bench.is_measured()) try_without_idle_causes(level, all);
    if (try_crossing(level, all)) try_fewer(level, all);
}

// Each cause of the best set beside the causes of its rivals, which were not extended: one of them may hold
// what another cause of the best set stands for. Whether one is better.
bool CauseSearch::try_crossing(const Level& level, Fits& all) {
    constexpr std::size_t max_sets = 6;
    const ScoredFit best = all.front();
    if (best.fit.bench != &level.bench || best.fit.causes.size() < 2) return false;
    std::vector<Hypothesis> sets;
    for (const ScoredFit& rival : all) {
        const Hypothesis set = rival.fit.hypothesis();
        if (rival.evidence < best.evidence - far_behind * sharpness()) break;
        if (set.bench != best.fit.bench || is_nothing(set.causes) || set.causes.size() >= max_causes)
            continue;
        Eigen::Index next = level.bench.size();
        for (const CandidateCause* cause : best.fit.causes) {
            const auto count = static_cast<Eigen::Index>(cause->numbers.size());
            const Hypothesis crossed = with_cause(set, cause, best.fit.coordinates.segment(next, count));
            next += count;
            const auto excludes_it = [&](const CandidateCause* other) {
                return other->effect == cause->effect ||
                       is_slowness_of_one_sensor(cause->effect, cause->variant, *other);
            };
            const auto is_known = [&](const Hypothesis& other) {
                return other.bench == set.bench && are_same_causes(other.causes, crossed.causes);
            };
            if (std::any_of(set.causes.begin(), set.causes.end(), excludes_it) ||
                std::any_of(sets.begin(), sets.end(), is_known) ||
                fit_of(all, crossed.causes, set.bench) != nullptr)
                continue;
            if (sets.size() < max_sets) sets.push_back(crossed);
        }
    }
    if (sets.empty() || is_out_of_time()) return false;
    report("fitting " + in_words(sets.front().causes));
    add_fits(level, sets, false, all);
    sort(level, all);
    return all.front().evidence > best.evidence;
}

// Others in the place of a single cause, from where it led the bench's own numbers: where these float widely,
// several causes explain much the same, and each deserves the same start.
void CauseSearch::try_others(const Level& level, Fits& all) {
    const CauseFit best = all.front().fit;
    if (is_nothing(best.causes) || best.causes.size() > 1 || is_out_of_time()) return;
    Fits others;
    add_sets(level, only_causes(best.hypothesis(), [](const CandidateCause&) { return false; }), best.weights,
             max_fitted_further, others);
    std::move(others.begin(), others.end(), std::back_inserter(all));
    sort(level, all);
}

// The causes of a fit and, in the place of a gain or a delay that it took into the numbers of the bench, that
// gain or delay or a lag of the same sensor.
std::vector<Hypothesis> CauseSearch::with_faults_of_sensors(const Level& level, const ScoredFit& fit) {
    std::vector<Hypothesis> sets;
    if (fit.fit.bench != &level.bench) return sets;
    for (const ScoredFit::FarNumber& far : fit.far_numbers) {
        const FloatingNumber& number = level.bench.numbers[far.number];
        if (number.usual == 0.0) continue;
        const auto row = static_cast<Eigen::Index>(far.number);
        const double coordinate = fit.fit.coordinates[row];
        Hypothesis usual = only_causes(fit.fit.hypothesis(),
                                       [](const CandidateCause& cause) { return cause.effect != "none"; });
        usual.coordinates[row] = 0.0;
        for (const CandidateCause& cause : level.causes) {
            const bool is_the_same = cause.effect == number.effect && cause.variant == number.variant;
            if (!is_the_same && !is_slowness_of_one_sensor(number.effect, number.variant, cause)) continue;
            if (cause.effect == "sensor_lag" && coordinate < 0.0) continue;
            // A lag is sought from beside the delay: alone it gives way to the delay that it replaces.
            usual.coordinates[row] = cause.effect == "sensor_lag" ? coordinate : 0.0;
            sets.push_back(with_cause(usual, &cause, as_size_of(cause, number, coordinate)));
        }
    }
    return sets;
}

// A gain or a delay that a fit took into the numbers of the bench is a cause where it is beyond what is
// usual, and a delay may stand for a lag of that sensor. Beside such a number the screening sees nothing of
// these causes. In a drive without a description much else can stand for a lag, and only delays are tried.
void CauseSearch::try_faults_of_the_bench(const Level& level, Fits& fits) {
    const ScoredFit* nothing = fit_without_cause(fits);
    if (nothing == nullptr || is_out_of_time()) return;
    std::vector<Hypothesis> faulty = with_faults_of_sensors(level, *nothing);
    if (is_undescribed(level.bench)) {
        std::erase_if(faulty, [&](const Hypothesis& set) {
            return set.causes.front()->effect == "sensor_lag" ||
                   std::any_of(fits.begin(), fits.end(), [&](const ScoredFit& fit) {
                       return fit.fit.bench == &level.bench && fit.fit.causes.front() == set.causes.front();
                   });
        });
    } else if (nothing != &fits.front()) {
        for (Hypothesis& set : with_faults_of_sensors(level, fits.front())) faulty.push_back(std::move(set));
    }
    std::erase_if(faulty,
                  [&](const Hypothesis& set) { return fit_of(fits, set.causes, &level.bench) != nullptr; });
    if (faulty.empty()) return;
    report("fitting " + in_words(faulty.front().causes));
    add_fits(level, faulty, false, fits);
    sort_by_evidence(fits);
}

// Causes that are sought last: alone, beside the best set, and in the place of each of its causes. Whether
// one is better.
bool CauseSearch::try_last(const Level& level, Fits& all) {
    constexpr std::size_t promising = 2;
    const ScoredFit best = all.front();
    const Hypothesis found = best.fit.hypothesis();
    const bool found_nothing = is_nothing(found.causes);
    if (level.sought_last().empty() || is_out_of_time() ||
        (!worth_a_further_cause(best) && (found_nothing || only_corrects_the_model(best, all))))
        return false;
    Fits sets;
    const auto add = [&](const Hypothesis& beside, std::size_t count) {
        add_sets(level, level.sought_last(), beside, best.fit.weights, count, sets);
    };
    add(only_causes(found, [](const CandidateCause&) { return false; }), promising);
    if (!found_nothing && found.causes.size() < max_causes) add(found, promising);
    if (found.causes.size() > 1)
        for (const Hypothesis& fewer : without_each(found)) add(fewer, 1);
    std::move(sets.begin(), sets.end(), std::back_inserter(all));
    sort(level, all);
    return all.front().evidence > best.evidence;
}

std::span<const CandidateCause> CauseSearch::Level::sought_last() const {
    const auto first = std::find_if(causes.begin(), causes.end(),
                                    [](const CandidateCause& cause) { return cause.is_sought_last; });
    return {first, causes.end()};
}

std::span<const CandidateCause> CauseSearch::Level::sought_first() const {
    return {causes.begin(), causes.size() - sought_last().size()};
}

// The best set without each of its causes in turn, from where the set led: a smaller set may have been left
// in a local minimum. Whether one is better.
bool CauseSearch::try_fewer(const Level& level, Fits& all) {
    bool is_better = false;
    for (Hypothesis best = all.front().fit.hypothesis(); !is_nothing(best.causes) && !is_out_of_time();) {
        if (best.causes.size() == 1 && level.bench.is_measured()) break;
        report("trying fewer causes");
        std::vector<Hypothesis> fewer = without_each(best);
        if (fewer.front().causes.empty())
            fewer.front() = with_cause(fewer.front(), &level.causes.front(), {});
        add_fits(level, fewer, false, all);
        sort(level, all);
        if (are_same_causes(all.front().fit.causes, best.causes)) break;
        is_better = true;
        best = all.front().fit.hypothesis();
    }
    return is_better;
}

// One of the causes of a set may do nothing beside the others, and yet have led the numbers on: on a measured
// bench the set that leaves least is tried without each of its causes, on a bench as built every set without
// a cause that does nothing, where the set without it was left clearly behind.
void CauseSearch::try_without_idle_causes(const Level& level, Fits& all) {
    if (is_out_of_time()) return;
    std::vector<Hypothesis> fewer =
        level.bench.is_measured() ? without_each_of_closest_fit(all) : without_idle_causes(all);
    if (fewer.empty()) return;
    report("trying fewer causes");
    add_fits(level, fewer, false, all);
    sort(level, all);
}

// The best set from each smaller one. A set that was built up cause by cause may have been left in a local
// minimum, which shows in what it leaves, and another order leads elsewhere.
void CauseSearch::try_from_smaller_sets(const Level& level, Fits& all) {
    const CauseFit best = all.front().fit;
    if (best.causes.size() < 2 || all.front().misfit <= as_good_as_noise || is_out_of_time()) return;
    std::vector<Hypothesis> starts;
    Eigen::Index first = level.bench.size();
    const std::vector<Hypothesis> fewer = without_each(best.hypothesis());
    for (std::size_t k = 0; k < best.causes.size(); ++k) {
        const CandidateCause* cause = best.causes[k];
        const auto count = static_cast<Eigen::Index>(cause->numbers.size());
        const ScoredFit* smaller = fit_of(all, fewer[k].causes, best.bench);
        if (smaller != nullptr)
            starts.push_back(
                with_cause(smaller->fit.hypothesis(), cause, best.coordinates.segment(first, count)));
        first += count;
    }
    if (starts.empty()) return;
    report("fitting " + in_words(best.causes));
    add_fits(level, starts, false, all);
    sort(level, all);
}

// Further causes beside a set that is better without one: what that cause stood for. Whether one is better.
bool CauseSearch::try_more(const Level& level, Fits& all) {
    if (is_out_of_time()) return false;
    const double before = all.front().evidence;
    Fits sets = larger_sets(level, {all.front()});
    std::move(sets.begin(), sets.end(), std::back_inserter(all));
    sort(level, all);
    return all.front().evidence > before + clear_gain;
}

// The best set without the cause without which it loses least; null where none of these was fitted.
const ScoredFit* CauseSearch::with_one_cause_fewer(const Fits& all) {
    const std::vector<const CandidateCause*>& best = all.front().fit.causes;
    const auto is_of_best = [&](const CandidateCause* cause) {
        return std::find(best.begin(), best.end(), cause) != best.end();
    };
    const auto fewer = std::find_if(all.begin(), all.end(), [&](const ScoredFit& each) {
        const std::vector<const CandidateCause*>& causes = each.fit.causes;
        return causes.size() + 1 == best.size() && std::all_of(causes.begin(), causes.end(), is_of_best);
    });
    return fewer == all.end() ? nullptr : &*fewer;
}

// Others in the place of the cause without which the best set loses least. Whether one is better.
bool CauseSearch::replace_the_weakest(const Level& level, Fits& all) {
    const ScoredFit best = all.front();
    const ScoredFit* fewer = with_one_cause_fewer(all);
    if (best.fit.causes.size() < 3 || fewer == nullptr || is_out_of_time()) return false;
    Fits sets;
    add_sets(level, fewer->fit.hypothesis(), fewer->fit.weights, max_fitted_beside_the_best, sets);
    std::move(sets.begin(), sets.end(), std::back_inserter(all));
    sort(level, all);
    return all.front().evidence > best.evidence + clear_gain;
}

const CandidateCause* CauseSearch::Level::same_cause(const std::string& effect,
                                                     const std::string& variant) const {
    const auto same = std::find_if(causes.begin(), causes.end(), [&](const CandidateCause& cause) {
        return cause.effect == effect && cause.variant == variant;
    });
    return same == causes.end() ? nullptr : &*same;
}

// What was found on the bench as it is built, with measured numbers instead: a number that is visibly not
// what was stated becomes a cause. None where that makes too many causes, or one that is not sought.
std::optional<Hypothesis> CauseSearch::with_measured_numbers(const ScoredFit& found) const {
    const CauseFit& fit = found.fit;
    if (fit.causes.size() + found.visible_numbers.size() > max_causes) return {};
    Hypothesis measured = nominal_hypothesis(described_.bench);
    Eigen::Index next = fit.bench->size();
    for (const CandidateCause* cause : fit.causes) {
        const auto count = static_cast<Eigen::Index>(cause->numbers.size());
        const CandidateCause* same = described_.same_cause(cause->effect, cause->variant);
        if (same == nullptr) return {};
        if (same->effect != "none")
            measured = with_cause(measured, same, fit.coordinates.segment(next, count));
        next += count;
    }
    for (const std::size_t visible : found.visible_numbers) {
        const FloatingNumber& number = fit.bench->numbers[visible];
        const double coordinate = fit.coordinates[static_cast<Eigen::Index>(visible)];
        const CandidateCause* same = described_.same_cause(number.effect, number.variant);
        if (same == nullptr) return {};
        // The built bench may have a cause and a floating number of the same kind, as two parts of a zero.
        if (std::find(measured.causes.begin(), measured.causes.end(), same) != measured.causes.end())
            continue;
        if (visible < nominal_coordinates)
            measured.coordinates[static_cast<Eigen::Index>(visible)] = coordinate;
        measured = with_cause(
            measured, same,
            visible < nominal_coordinates ? Eigen::VectorXd() : as_size_of(*same, number, coordinate));
    }
    return measured.causes.empty() ? std::nullopt : std::optional(measured);
}

// Rough knowledge of all numbers may stand for a second cause, and its many numbers take up a part of the
// first one. So the best sets are tried on the measured bench, where they pay for no such numbers, and the
// best of them there without each of its causes in turn.
void CauseSearch::add_measured_sets(const Fits& built, Fits& all) {
    constexpr std::size_t max_sets = 3;
    constexpr double max_behind = 20.0;
    CauseFitter::FitOptions options;
    options.any_size = false;
    Fits sets;
    const auto add = [&](const Hypothesis& start) {
        if (is_out_of_time() || fit_of(sets, start.causes) != nullptr) return;
        report("fitting " + in_words(start.causes));
        sets.push_back(fitted(described_, start, options));
    };
    for (std::size_t k = 0; k < std::min(max_sets, built.size()); ++k) {
        if (built[k].evidence < built.front().evidence - max_behind) break;
        const std::optional<Hypothesis> start = with_measured_numbers(built[k]);
        if (!start) continue;
        add(*start);
        // Wrong numbers compensate one another, so that none of them can be dropped alone.
        Hypothesis stated =
            only_causes(*start, [](const CandidateCause& cause) { return !cause.numbers.empty(); });
        if (stated.causes.empty() || stated.causes.size() == start->causes.size()) continue;
        stated.coordinates.head(nominal_coordinates).setZero();
        add(stated);
    }
    if (sets.empty()) return;
    sort_by_evidence(sets);
    try_fewer(described_, sets);
    if (sets.front().evidence > all.front().evidence) {
        try_replacing(described_, sets);
        try_confusable(described_, sets);
    }
    std::move(sets.begin(), sets.end(), std::back_inserter(all));
    sort_by_evidence(all);
}

// Whether nothing at all explains a recording better, once the best single cause has paid for following the
// model's own error (E70).
bool CauseSearch::only_corrects_the_model(const ScoredFit& single, const Fits& singles) const {
    const ScoredFit* nothing = fit_without_cause(singles);
    return nothing != nullptr && single.fit.causes.size() == 1 &&
           single.uncharged_evidence() - evidence_.penalty_of_corrections(single, singles) <
               nothing->evidence;
}

// The best of the smaller sets, each with one cause more; then without each of its former causes in turn, for
// the first cause may have stood for two others.
CauseSearch::Fits CauseSearch::larger_sets(const Level& level, const Fits& smaller) {
    Fits sets;
    const ScoredFit& best = smaller.front();
    // A pair is tried whatever a first cause leaves, because that cause may stand for both, unless it only
    // corrects the model.
    const bool seeks_pairs = best.fit.causes.size() == 1 && !is_nothing(best.fit.causes) &&
                             !only_corrects_the_model(best, smaller);
    if (!seeks_pairs && !worth_a_further_cause(best)) return sets;
    std::vector<std::string> extended;  // by the cause that was added last
    for (const ScoredFit& each : smaller) {
        const bool is_single = each.fit.causes.size() == 1;
        const std::string added = each.fit.causes.back()->effect;
        if (added == "none" || extended.size() == max_extended ||
            std::find(extended.begin(), extended.end(), added) != extended.end())
            continue;
        if (!is_single && !extended.empty() && !recording_.is_undescribed_drive()) break;
        extended.push_back(added);
        const bool is_wide = extended.size() == 1 && !level.bench.is_measured();
        if (seeks_pairs || worth_a_further_cause(each))
            add_sets(level, each.fit.hypothesis(), each.fit.weights,
                     is_wide ? max_fitted_beside_the_best : max_fitted_further, sets);
    }
    if (seeks_pairs && !is_undescribed(level.bench)) add_promising_pairs(level, smaller, sets);
    sort_by_evidence(sets);
    if (sets.empty() || sets.front().fit.causes.size() > 2) return sets;
    if (worth_a_further_cause(sets.front())) try_replacing(level, sets);
    return sets;
}

// Pairs of which neither cause explains much alone. On a measured bench they are sought where a single cause
// leaves more than noise and floor, even if that is within the error of its law: the cause may stand for two
// others.
void CauseSearch::add_promising_pairs(const Level& level, const Fits& singles, Fits& sets) {
    const ScoredFit& best = singles.front();
    const bool leaves_something =
        level.bench.is_measured() ? best.misfit > as_good_as_noise : worth_a_further_cause(best);
    const ScoredFit* nothing = fit_without_cause(singles);
    if (!leaves_something || nothing == nullptr || is_out_of_time()) return;
    report("screening pairs of causes");
    std::vector<Hypothesis> starts;
    std::size_t tried = 0;
    for (const ScreenedPair& pair :
         screen_pairs(rough_model().fitter, level.sought_first(), nominal_hypothesis(level.bench),
                      nothing->fit.weights, promising_starts())) {
        if (is_slowness_of_one_sensor(pair.second->effect, pair.second->variant, *pair.first)) continue;
        if (tried++ == max_fitted_further) break;
        const std::vector<const CandidateCause*> causes = {pair.first, pair.second};
        if (fit_of(sets, causes) == nullptr)
            starts.push_back(
                with_cause(with_cause(nominal_hypothesis(level.bench), pair.first, pair.start_of_first),
                           pair.second, pair.start_of_second));
    }
    if (!starts.empty()) add_fits(level, starts, level.bench.is_measured(), sets);
}

// Others in the place of each cause of the best set in turn, the one that was found last first.
void CauseSearch::try_replacing(const Level& level, Fits& sets) {
    const CauseFit best = sets.front().fit;
    if (best.causes.size() < 2) return;
    for (auto replaced = best.causes.rbegin(); replaced != best.causes.rend(); ++replaced)
        add_sets(
            level,
            only_causes(best.hypothesis(), [&](const CandidateCause& cause) { return &cause != *replaced; }),
            best.weights, max_fitted_further, sets);
    sort_by_evidence(sets);
}

// The screening is linear. Where the bench's numbers float widely they make up for most of what a cause does,
// and what is left of it shows only after they have moved: there a first cause gets a few steps of a search
// whatever the screening says, and a further one if it is among the most promising. The numbers that a bench
// without a cause led to may be far from where they are with one, so that a first cause also begins
// elsewhere.
std::vector<CauseSearch::Further> CauseSearch::screened(const Level& level,
                                                        std::span<const CandidateCause> causes,
                                                        const Hypothesis& present,
                                                        const SeriesWeights& weights, bool begins_elsewhere) {
    constexpr std::size_t most_promising = 12;
    std::vector<Further> all;
    for (const Screened& each : screen(rough_model().fitter, causes, present, weights, &promising_starts())) {
        if (!level.bench.is_measured() && !present.causes.empty() && all.size() == most_promising) break;
        if (&level == &built_ && behind_the_best(each.sum_of_squares, weights) > hopeless * sharpness())
            continue;
        all.push_back({each.cause, with_cause(present, each.cause, each.start), each.sum_of_squares});
    }
    if (level.bench.is_measured()) return all;
    std::vector<Eigen::VectorXd> elsewhere;
    if (begins_elsewhere) {
        elsewhere = further_starts(level.bench);
        elsewhere.push_back(nominal_hypothesis(level.bench).coordinates);
    }
    // A drive's first causes move its numbers far, so that derivatives without them lead nowhere.
    const bool begins_with_derivatives =
        !is_undescribed(level.bench) || (recording_.is_undescribed_drive() && !present.causes.empty());
    if (!begins_with_derivatives) {
        fit_roughly(all, weights, elsewhere);
        return all;
    }
    const WideDerivatives there = rough_model().fitter.wide_derivatives(present);
    fit_roughly(all, weights, elsewhere, there);
    if (is_undescribed(level.bench)) return all;
    mark_those_behind(present, weights, there, all);
    return all;
}

// After a few steps of a search, what a cause leaves tells whether it can still lead. Where nothing is
// described, the steps begin too far off.
void CauseSearch::mark_those_behind(const Hypothesis& present, const SeriesWeights& weights,
                                    const WideDerivatives& there, std::vector<Further>& all) {
    constexpr double least_gain = 2.0;  // a further cause costs more
    const CauseFitter& fitter = rough_model().fitter;
    Eigen::VectorXd left = there.residuals;
    fitter.apply(weights, left);
    const double without =
        left.squaredNorm() + fitter.prior_residuals(present, present.coordinates).squaredNorm();
    const double least = all.empty() ? without : all.front().sum_of_squares;
    for (Further& each : all) {
        each.is_behind =
            fitter.behind(each.sum_of_squares, least) > far_behind * sharpness() ||
            behind_the_best(each.sum_of_squares, weights) > far_behind * sharpness() ||
            (!present.causes.empty() && fitter.behind(without, each.sum_of_squares) < least_gain);
    }
}

// By how much evidence what is left here, with these weights, is behind what the best fit so far leaves.
double CauseSearch::behind_the_best(double sum_of_squares, const SeriesWeights& weights) const {
    const CauseFitter& fitter = coarse_.fitter;
    if (best_leaves_.size() == 0) return 0.0;
    Eigen::VectorXd left = best_leaves_;
    fitter.apply(weights, left);
    return fitter.behind(sum_of_squares, left.squaredNorm());
}

// A few steps of a search for each, also with these numbers of the bench without other causes; the most
// promising first. First causes of a drive also begin at sizes that are held.
void CauseSearch::fit_roughly(std::vector<Further>& all, const SeriesWeights& weights,
                              std::span<const Eigen::VectorXd> elsewhere, const WideDerivatives& known) {
    const bool holds_sizes = recording_.is_undescribed_drive() && !elsewhere.empty() &&
                             rough_model().left_without_cause > as_good_as_noise;
    parallel_for_each_index(static_cast<int>(all.size()), options_.threads, [&](int index) {
        Further& further = all[static_cast<std::size_t>(index)];
        further.sum_of_squares = std::numeric_limits<double>::infinity();
        if (is_out_of_time()) return;
        const auto own = static_cast<Eigen::Index>(further.cause->numbers.size());
        std::vector<Hypothesis> starts = {further.start};
        for (const Eigen::VectorXd& numbers : elsewhere)
            starts.push_back(with_cause({{}, numbers, further.start.bench}, further.cause,
                                        further.start.coordinates.tail(own)));
        CauseFit rough = roughly_fitted(starts, weights, known);
        if (holds_sizes) {
            std::optional<CauseFit> held =
                rough_model().fitter.rough_fit_from_held_sizes(starts.front(), weights);
            if (held) evaluations_ += held->evaluations;
            if (held && held->sum_of_squares < rough.sum_of_squares) rough = *std::move(held);
        }
        further.start = rough.hypothesis();
        further.sum_of_squares = rough.sum_of_squares;
    });
    std::stable_sort(all.begin(), all.end(),
                     [](const Further& a, const Further& b) { return a.sum_of_squares < b.sum_of_squares; });
}

// `weights`: of the fit that the hypothesis comes from; `max_further`: causes that are tried beside it.
void CauseSearch::add_sets(const Level& level, std::span<const CandidateCause> causes,
                           const Hypothesis& hypothesis, const SeriesWeights& weights,
                           std::size_t max_further, Fits& sets) {
    std::size_t further = 0;
    std::vector<Hypothesis> starts;
    for (const Further& each : screened(level, causes, hypothesis, weights, false)) {
        if (further == max_further || is_out_of_time()) break;
        const bool known =
            std::any_of(hypothesis.causes.begin(), hypothesis.causes.end(), [&](const CandidateCause* cause) {
                return (cause->effect == each.cause->effect && cause->variant == each.cause->variant) ||
                       is_part_of(*each.cause, *cause) ||
                       is_slowness_of_one_sensor(each.cause->effect, each.cause->variant, *cause);
            });
        if (known || each.is_behind) continue;
        ++further;
        std::vector<const CandidateCause*> set = hypothesis.causes;
        set.push_back(each.cause);
        // Where the bench's numbers float widely, a set leads elsewhere from another start.
        if (level.bench.is_measured() && fit_of(sets, set) != nullptr) continue;
        starts.push_back(each.start);
    }
    if (starts.empty()) return;
    report("fitting " + in_words(starts.front().causes));
    add_fits(level, starts, level.bench.is_measured(), sets);
}

// Single causes of an undescribed bench, from further numbers of it.
void CauseSearch::add_from_elsewhere(const Level& level, std::span<const Further> some,
                                     const SeriesWeights& weights, Fits& singles) {
    for (const Further& each : some) {
        if (each.cause->numbers.empty() || is_out_of_time()) continue;
        std::vector<Hypothesis> starts;
        const auto own = static_cast<Eigen::Index>(each.cause->numbers.size());
        for (const Eigen::VectorXd& numbers : further_starts(level.bench))
            starts.push_back(
                with_cause({{}, numbers, &level.bench}, each.cause, each.start.coordinates.tail(own)));
        report("fitting " + in_words(starts.front().causes));
        Fits fits = made_side_by_side(model_of(level), starts.size(), [&](std::size_t k) {
            CauseFitter::FitOptions options;
            options.any_size = false;
            return fit_on(level, roughly_fitted({&starts[k], 1}, weights).hypothesis(), options);
        });
        std::move(fits.begin(), fits.end(), std::back_inserter(singles));
    }
}

void CauseSearch::add_fits(const Level& level, const std::vector<Hypothesis>& starts, bool any_size,
                           Fits& fits) {
    CauseFitter::FitOptions options;
    options.pruned_sum_of_squares = pruned_at(fits);
    options.any_size = any_size;
    Fits made = made_side_by_side(model_of(level), starts.size(),
                                  [&](std::size_t k) { return fit_on(level, starts[k], options); });
    std::move(made.begin(), made.end(), std::back_inserter(fits));
}

}  // namespace capstan::gap
