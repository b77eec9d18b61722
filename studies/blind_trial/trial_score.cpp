#include "capstan/blind_trial/trial_score.h"

#include <algorithm>
#include <array>
#include <cmath>
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
    const Reference* reference;   // null: not known
    std::set<std::string> truth;  // effects; `none` where there is none
};

std::set<std::string> truth_of(const CaseLabel& label) {
    std::set<std::string> truth;
    for (const TrueCause& cause : label.causes) truth.insert(cause.effect);
    if (truth.empty()) truth.insert("none");
    return truth;
}

bool among_first(const ScoredCase& scored, std::size_t count) {
    const auto& ranked = scored.answer->ranked;
    return std::any_of(ranked.begin(),
                       ranked.begin() + static_cast<std::ptrdiff_t>(std::min(count, ranked.size())),
                       [&](const gap::RankedEffect& each) { return scored.truth.count(each.effect) > 0; });
}

std::string leading(const ScoredCase& scored) {
    return scored.answer->ranked.empty() ? "" : scored.answer->ranked.front().effect;
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
    for (const gap::RankedEffect& each : scored.answer->ranked) effects.insert(each.effect);
    double sum = 0.0;
    for (const std::string& effect : effects) {
        double stated = 0.0;
        for (const gap::RankedEffect& each : scored.answer->ranked) {
            if (each.effect == effect) stated += each.probability;
        }
        const double true_fraction =
            scored.truth.count(effect) > 0 ? 1.0 / static_cast<double>(scored.truth.size()) : 0.0;
        sum += (stated - true_fraction) * (stated - true_fraction);
    }
    return sum;
}

// The two effects of a pair share the probability in the answer, so the stated one is their sum. A verdict of
// `unknown` names the best fitting effects too, but the probability is not theirs.
double stated_probability(const ScoredCase& scored) {
    const CaseAnswer& answer = *scored.answer;
    if (answer.ranked.empty()) return 0.0;
    const auto is_named = [&](const std::string& effect) {
        return std::find(answer.named.begin(), answer.named.end(), effect) != answer.named.end();
    };
    if (answer.named.size() < 2 || !is_named(answer.ranked.front().effect))
        return answer.ranked.front().probability;
    double sum = 0.0;
    for (const gap::RankedEffect& each : answer.ranked) {
        if (is_named(each.effect)) sum += each.probability;
    }
    return std::min(1.0, sum);
}

Calibration calibrate(const std::vector<ScoredCase>& cases) {
    constexpr int bin_count = 10;
    std::array<ReliabilityBin, bin_count> bins;
    Calibration calibration;
    if (cases.empty()) return calibration;
    for (const ScoredCase& scored : cases) {
        calibration.brier += brier_of(scored) / static_cast<double>(cases.size());
        const double stated = stated_probability(scored);
        const int index = std::clamp(static_cast<int>(stated * bin_count), 0, bin_count - 1);
        ReliabilityBin& bin = bins[static_cast<std::size_t>(index)];
        ++bin.cases;
        bin.mean_probability += stated;
        bin.fraction_right += among_first(scored, 1) ? 1.0 : 0.0;
    }
    for (int k = 0; k < bin_count; ++k) {
        ReliabilityBin& bin = bins[static_cast<std::size_t>(k)];
        if (bin.cases == 0) continue;
        bin.from = static_cast<double>(k) / bin_count;
        bin.to = static_cast<double>(k + 1) / bin_count;
        bin.mean_probability /= bin.cases;
        bin.fraction_right /= bin.cases;
        calibration.ece += std::abs(bin.mean_probability - bin.fraction_right) * bin.cases /
                           static_cast<double>(cases.size());
        calibration.bins.push_back(bin);
    }
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
        after.push_back(claimed->after / truth->after);
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
    const auto& ranked = scored.answer->ranked;
    return ranked.size() >= 2 && std::set<std::string>{ranked[0].effect, ranked[1].effect} == scored.truth;
}

constexpr double z95 = 1.959963984540054;

// Wilson's interval: middle and half width.
std::pair<double, double> wilson(double fraction, int of) {
    const double n = of;
    const double middle = (fraction + z95 * z95 / (2.0 * n)) / (1.0 + z95 * z95 / n);
    const double half =
        z95 / (1.0 + z95 * z95 / n) * std::sqrt(fraction * (1.0 - fraction) / n + z95 * z95 / (4.0 * n * n));
    return {middle, half};
}

}  // namespace

double Fraction::low() const {
    if (of == 0) return 0.0;
    const auto [middle, half] = wilson(value(), of);
    return std::max(0.0, middle - half);
}

double Fraction::high() const {
    if (of == 0) return 1.0;
    const auto [middle, half] = wilson(value(), of);
    return std::min(1.0, middle + half);
}

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
            cases.push_back({&label, answer, find_named(references, label.name), truth_of(label)});
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
            case TruthGroup::three:
                score.both_of_mixtures.count(first_two_are_the_two(scored));
                [[fallthrough]];
            case TruthGroup::catalogue:
            case TruthGroup::parameter:
                score.missed_gaps.count(first == "none");
                score.needless_unknown.count(first == "unknown");
                break;
        }
    }
    score.calibration = calibrate(cases);
    score_places(cases, score);
    score.load_torque = shrinkage_in(cases, channel::load_torque);
    score.clearest_channel = shrinkage_in(cases, "");
    return score;
}

}  // namespace capstan::gap_trial
