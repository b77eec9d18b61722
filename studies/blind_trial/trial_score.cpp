#include "capstan/blind_trial/trial_score.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "capstan/platform/statistics.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

constexpr double close_place_m = 0.15;
constexpr double as_good_factor = 1.1;

struct ScoredCase {
    const CaseLabel* label;
    const CaseAnswer* answer;
    const Reference* reference;          // null: not known
    std::set<std::string> truth;         // effects; `none` where there is none
    std::vector<AnsweredEffect> ranked;  // without nuisances
    std::vector<std::string> named;      // likewise
};

ScoredCase scored_case(const CaseLabel& label, const CaseAnswer& answer, const Reference* reference) {
    const CaseTruth truth = truth_of(label);
    ScoredCase scored{&label, &answer, reference, truth.causes, judged(answer, truth), {}};
    if (scored.truth.empty()) scored.truth.insert("none");
    std::copy_if(answer.named.begin(), answer.named.end(), std::back_inserter(scored.named),
                 [&](const std::string& effect) { return truth.nuisances.count(effect) == 0; });
    return scored;
}

bool among_first(const ScoredCase& scored, std::size_t count) {
    const auto& ranked = scored.ranked;
    return std::any_of(ranked.begin(),
                       ranked.begin() + static_cast<std::ptrdiff_t>(std::min(count, ranked.size())),
                       [&](const AnsweredEffect& each) { return scored.truth.count(each.effect) > 0; });
}

std::string leading(const ScoredCase& scored) {
    return scored.ranked.empty() ? "none" : scored.ranked.front().effect;
}

bool family_is_right(const ScoredCase& scored) {
    return std::any_of(scored.truth.begin(), scored.truth.end(), [&](const std::string& effect) {
        return effect_family(effect) == effect_family(leading(scored));
    });
}

// The groups that a case belongs to, as (by, name).
std::vector<std::pair<std::string, std::string>> groups_of(const CaseLabel& label) {
    std::vector<std::pair<std::string, std::string>> groups = {{"all", "all cases"},
                                                               {"truth", truth_group_name(label.group)}};
    if (label.severity) groups.push_back({"severity", severity_name(*label.severity)});
    groups.push_back({"bench", label.bench});
    groups.push_back({"runs", std::to_string(label.protocols.size())});
    if (label.group == TruthGroup::catalogue || label.group == TruthGroup::parameter)
        groups.push_back({"effect", label.causes.front().effect});
    if (label.group == TruthGroup::foreign) groups.push_back({"outside", label.causes.front().kind});
    return groups;
}

std::vector<GroupScore> score_groups(const std::vector<ScoredCase>& cases) {
    const std::vector<std::string> order = {"all", "truth", "severity", "bench", "runs", "effect", "outside"};
    std::vector<GroupScore> groups;
    for (const ScoredCase& scored : cases) {
        for (const auto& [by, name] : groups_of(*scored.label)) {
            auto group = std::find_if(
                groups.begin(), groups.end(),
                [&by = by, &name = name](const GroupScore& g) { return g.by == by && g.name == name; });
            if (group == groups.end()) group = groups.insert(groups.end(), {by, name, {}, {}, {}});
            group->top1.count(among_first(scored, 1));
            group->top3.count(among_first(scored, 3));
            group->family.count(family_is_right(scored));
        }
    }
    const auto place = [&](const std::string& by) { return std::find(order.begin(), order.end(), by); };
    std::stable_sort(groups.begin(), groups.end(), [&](const GroupScore& a, const GroupScore& b) {
        return a.by != b.by ? place(a.by) < place(b.by) : a.name < b.name;
    });
    return groups;
}

double brier_of(const ScoredCase& scored) {
    std::set<std::string> effects = scored.truth;
    for (const AnsweredEffect& each : scored.ranked) effects.insert(each.effect);
    double sum = 0.0;
    for (const std::string& effect : effects) {
        double stated = 0.0;
        for (const AnsweredEffect& each : scored.ranked) {
            if (each.effect == effect) stated += each.probability;
        }
        const double true_fraction =
            scored.truth.count(effect) > 0 ? 1.0 / static_cast<double>(scored.truth.size()) : 0.0;
        sum += (stated - true_fraction) * (stated - true_fraction);
    }
    return sum;
}

// A verdict of several effects states their sum, and is right if all of them are there. A verdict of
// `unknown` names the best fitting effects too, but the probability is not theirs.
struct Verdict {
    double probability = 0.0;
    bool is_right = false;
};

Verdict verdict_of(const ScoredCase& scored) {
    const auto is_named = [&](const std::string& effect) {
        return std::find(scored.named.begin(), scored.named.end(), effect) != scored.named.end();
    };
    if (scored.ranked.empty()) return {0.0, among_first(scored, 1)};
    if (scored.named.size() < 2 || !is_named(scored.ranked.front().effect))
        return {scored.ranked.front().probability, among_first(scored, 1)};
    double sum = 0.0;
    for (const AnsweredEffect& each : scored.ranked) {
        if (is_named(each.effect)) sum += each.probability;
    }
    return {std::min(1.0, sum),
            std::all_of(scored.named.begin(), scored.named.end(),
                        [&](const std::string& effect) { return scored.truth.count(effect) > 0; })};
}

Calibration calibrate(const std::vector<ScoredCase>& cases) {
    Calibration calibration;
    Reliability reliability;
    for (const ScoredCase& scored : cases) {
        calibration.brier += brier_of(scored) / static_cast<double>(cases.size());
        const Verdict verdict = verdict_of(scored);
        reliability.add(verdict.probability, verdict.is_right);
    }
    calibration.bins = reliability.bins();
    calibration.ece = reliability.calibration_error();
    calibration.ece_by_chance = reliability.calibration_error_by_chance();
    return calibration;
}

const ChannelRms* find_channel(const std::vector<ChannelRms>& channels, const std::string& name) {
    for (const ChannelRms& each : channels) {
        if (each.channel == name) return &each;
    }
    return nullptr;
}

// `channel` empty: the one where the (first) effect is clearest.
Shrinkage shrinkage_in(const std::vector<ScoredCase>& cases, const std::string& channel) {
    Shrinkage shrinkage;
    std::vector<double> before;
    std::vector<double> after;
    for (const ScoredCase& scored : cases) {
        if (scored.reference == nullptr || !scored.reference->channels) continue;
        const std::string name = channel.empty() ? scored.label->causes.front().clearest_channel : channel;
        const ChannelRms* truth = find_channel(*scored.reference->channels, name);
        const ChannelRms* claimed = find_channel(scored.answer->channels, name);
        if (truth == nullptr || claimed == nullptr || truth->after <= 0.0) continue;
        before.push_back(claimed->before / truth->after);
        after.push_back(claimed->held_out.value_or(claimed->after) / truth->after);
        shrinkage.as_good_as_truth.count(after.back() <= as_good_factor);
    }
    shrinkage.cases = static_cast<int>(after.size());
    shrinkage.median_before = median(before);
    shrinkage.median_after = median(after);
    return shrinkage;
}

void score_places(const std::vector<ScoredCase>& cases, TrialScore& score) {
    std::vector<double> errors_m;
    for (const ScoredCase& scored : cases) {
        const bool single = scored.label->causes.size() == 1 && scored.label->group != TruthGroup::foreign;
        if (!single || !among_first(scored, 1)) continue;
        const TrueCause& truth = scored.label->causes.front();
        score.component.count(scored.answer->component == truth.component);
        if (!truth.end.empty()) score.end.count(scored.answer->end == truth.end);
        if (truth.where) {
            const double middle_m = 0.5 * (truth.where->from_m + truth.where->to_m);
            const bool told = scored.answer->position_m.has_value();
            if (told) errors_m.push_back(std::abs(*scored.answer->position_m - middle_m));
            score.place.count(told && errors_m.back() <= close_place_m);
        }
    }
    score.median_place_error_m = median(errors_m);
}

bool first_two_are_the_two(const ScoredCase& scored) {
    const auto& ranked = scored.ranked;
    return ranked.size() >= 2 && std::set<std::string>{ranked[0].effect, ranked[1].effect} == scored.truth;
}

}  // namespace

TrialScore score_trial(const TrialLabels& labels, const std::vector<CaseAnswer>& answers,
                       const std::vector<Reference>& references) {
    TrialScore score;
    std::vector<ScoredCase> cases;
    const auto find_named = [](const auto& items, const std::string& name) {
        const auto found =
            std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
        return found == items.end() ? nullptr : &*found;
    };
    for (const CaseLabel& label : labels.cases) {
        if (const CaseAnswer* answer = find_named(answers, label.name)) {
            cases.push_back(scored_case(label, *answer, find_named(references, label.name)));
        } else {
            score.unanswered.push_back(label.name);
        }
    }
    score.groups = score_groups(cases);
    for (const ScoredCase& scored : cases) {
        const std::string first = leading(scored);
        switch (scored.label->group) {
            case TruthGroup::none:
                score.false_alarms.count(first != "none");
                break;
            case TruthGroup::foreign:
                score.foreign_found.count(first == "unknown");
                score.missed_gaps.count(first == "none");
                break;
            case TruthGroup::mixture:
                score.both_of_mixtures.count(first_two_are_the_two(scored));
                [[fallthrough]];
            case TruthGroup::three:
            case TruthGroup::catalogue:
            case TruthGroup::parameter:
                score.missed_gaps.count(first == "none");
                score.needless_unknown.count(first == "unknown");
                break;
        }
    }
    score.calibration = calibrate(cases);
    std::vector<NamedCase> named;
    for (const ScoredCase& scored : cases) named.push_back({scored.label, scored.answer});
    score.causes = score_causes(named);
    score_places(cases, score);
    score.load_torque = shrinkage_in(cases, channel::load_torque);
    score.clearest_channel = shrinkage_in(cases, "");
    return score;
}

}  // namespace capstan::gap_trial
