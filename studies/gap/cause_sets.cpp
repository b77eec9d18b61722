#include <algorithm>

#include "capstan/gap/cause_search.h"

namespace capstan::gap {

namespace {

// How many causes get a full fit beside others.
constexpr std::size_t max_fitted_further = 3;
// How many of the best sets of one size are extended.
constexpr std::size_t max_extended = 2;
constexpr std::size_t max_causes = 5;

// A wrong nominal number beside a cause that lets the same number go far already.
bool is_part_of(const CandidateCause& cause, const CandidateCause& first) {
    if (!cause.numbers.empty()) return false;
    for (Eigen::Index number = 0; number < nominal_coordinates; ++number) {
        if (cause.nominal_std(number) > nominal_log_std && first.nominal_std(number) > nominal_log_std)
            return true;
    }
    return false;
}

}  // namespace

void CauseSearch::search_several(const Level& level, Fits& all) {
    Fits sets = all;
    for (std::size_t causes = 2; causes <= max_causes; ++causes) {
        sets = larger_sets(level, sets);
        if (sets.empty()) break;
        const bool better = sets.front().evidence > all.front().evidence;
        std::copy(sets.begin(), sets.end(), std::back_inserter(all));
        sort_by_evidence(all);
        if (!better) break;
    }
    try_fewer(level, all);
    if (!level.bench.is_measured()) try_others(level, all);
}

// Others in the place of each cause of the best set, from where the set led the bench's own numbers: where
// these float widely, several causes explain much the same, and each deserves the same start.
void CauseSearch::try_others(const Level& level, Fits& all) {
    constexpr int max_rounds = 2;
    constexpr std::size_t max_exchanged = 3;
    for (int round = 0; round < max_rounds && !is_out_of_time(); ++round) {
        const Hypothesis best = all.front().fit.hypothesis();
        if (best.causes.front()->effect == "none" || best.causes.size() > max_exchanged) return;
        const double before = all.front().evidence;
        Fits sets;
        for (const CandidateCause* dropped : best.causes)
            add_sets(level, only_causes(best, [&](const CandidateCause& cause) { return &cause != dropped; }),
                     sets);
        std::move(sets.begin(), sets.end(), std::back_inserter(all));
        sort_by_evidence(all);
        if (all.front().evidence == before) return;
    }
}

// The best set without each of its causes in turn, from where the set led: a smaller set may have been left
// in a local minimum.
void CauseSearch::try_fewer(const Level& level, Fits& all) {
    const auto is_nothing = [](const Hypothesis& hypothesis) {
        return hypothesis.causes.front()->effect == "none";
    };
    for (Hypothesis best = all.front().fit.hypothesis(); !is_nothing(best) && !is_out_of_time();) {
        if (best.causes.size() == 1 && level.bench.is_measured()) return;
        const double before = all.front().evidence;
        report("trying fewer causes");
        for (const CandidateCause* dropped : best.causes) {
            Hypothesis fewer =
                only_causes(best, [&](const CandidateCause& cause) { return &cause != dropped; });
            if (fewer.causes.empty()) fewer = with_cause(fewer, &level.causes.front(), {});
            CauseFitter::FitOptions options;
            options.any_size = false;
            all.push_back(fitted(level, fewer, options));
        }
        sort_by_evidence(all);
        if (all.front().evidence == before) return;
        best = all.front().fit.hypothesis();
    }
}

// The best of the smaller sets, each with one cause more; then without each of its former causes in turn, for
// the first cause may have stood for two others.
CauseSearch::Fits CauseSearch::larger_sets(const Level& level, const Fits& smaller) {
    Fits sets;
    if (!worth_a_further_cause(smaller.front())) return sets;
    std::vector<std::string> firsts;
    for (const ScoredFit& each : smaller) {
        const std::string& first = each.fit.causes.front()->effect;
        if (first == "none" || firsts.size() == max_extended ||
            (each.fit.causes.size() == 1 && std::find(firsts.begin(), firsts.end(), first) != firsts.end()))
            continue;
        if (each.fit.causes.size() > 1 && !firsts.empty()) break;
        firsts.push_back(first);
        if (worth_a_further_cause(each)) add_sets(level, each.fit.hypothesis(), sets);
    }
    sort_by_evidence(sets);
    if (sets.empty() || sets.front().fit.causes.size() > 2) return sets;
    if (!worth_a_further_cause(sets.front())) return sets;
    const Hypothesis best = sets.front().fit.hypothesis();
    for (const CandidateCause* kept : best.causes)
        add_sets(level, only_causes(best, [&](const CandidateCause& cause) { return &cause == kept; }), sets);
    sort_by_evidence(sets);
    return sets;
}

void CauseSearch::add_sets(const Level& level, const Hypothesis& hypothesis, Fits& sets) {
    std::size_t further = 0;
    for (const Screened& each : screen(coarse_.fitter, level.causes, hypothesis)) {
        if (further == max_fitted_further || is_out_of_time()) break;
        const bool known =
            std::any_of(hypothesis.causes.begin(), hypothesis.causes.end(), [&](const CandidateCause* cause) {
                return (cause->effect == each.cause->effect && cause->variant == each.cause->variant) ||
                       is_part_of(*each.cause, *cause);
            });
        if (known) continue;
        ++further;
        std::vector<const CandidateCause*> set = hypothesis.causes;
        set.push_back(each.cause);
        const auto same = [&](const ScoredFit& other) {
            return other.fit.causes.size() == set.size() &&
                   std::is_permutation(set.begin(), set.end(), other.fit.causes.begin());
        };
        if (std::any_of(sets.begin(), sets.end(), same)) continue;
        report("fitting " + in_words(set));
        CauseFitter::FitOptions options;
        options.pruned_sum_of_squares = pruned_at(sets);
        sets.push_back(fitted(level, with_cause(hypothesis, each.cause, each.start), options));
    }
}

}  // namespace capstan::gap
