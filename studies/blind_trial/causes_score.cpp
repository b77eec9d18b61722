#include "capstan/blind_trial/causes_score.h"

#include <algorithm>
#include <cmath>

namespace capstan::gap_trial {

namespace {

bool is_statement(const AnsweredEffect& each) {
    return each.effect != "none" && each.effect != "unknown";
}

std::string visibility_band(double visibility) {
    if (visibility < 1.5) return "below 1.5";
    return visibility < 4.0 ? "1.5 to 4" : "4 and more";
}

/// Groups in the order in which they are first counted; sorted by name at the end.
class Groups {
  public:
    CauseGroup& of(const std::string& by, const std::string& name) {
        const auto found = std::find_if(groups_.begin(), groups_.end(), [&](const CauseGroup& group) {
            return group.by == by && group.name == name;
        });
        return found != groups_.end() ? *found : *groups_.insert(groups_.end(), {by, name, {}, {}, {}, {}});
    }
    std::vector<CauseGroup> take() {
        const std::vector<std::string> order = {"all", "causes", "bench", "visibility", "effect"};
        const auto place = [&](const CauseGroup& group) {
            return std::find(order.begin(), order.end(), group.by) - order.begin();
        };
        std::stable_sort(groups_.begin(), groups_.end(), [&](const CauseGroup& a, const CauseGroup& b) {
            return place(a) != place(b) ? place(a) < place(b) : a.name < b.name;
        });
        return std::move(groups_);
    }

  private:
    std::vector<CauseGroup> groups_;
};

// What an answer says of a case, nuisances left out.
struct Said {
    CaseTruth truth;
    std::vector<AnsweredEffect> ranked;

    const AnsweredEffect* entry(const std::string& effect) const {
        const auto found = std::find_if(ranked.begin(), ranked.end(),
                                        [&](const AnsweredEffect& each) { return each.effect == effect; });
        return found == ranked.end() ? nullptr : &*found;
    }
    bool names(const std::string& effect) const {
        const AnsweredEffect* found = entry(effect);
        return found != nullptr && found->presence() >= named_from;
    }
    bool names_all() const {
        return std::all_of(truth.causes.begin(), truth.causes.end(),
                           [&](const std::string& effect) { return names(effect); });
    }
    bool names_what_is_not_there() const {
        return std::any_of(ranked.begin(), ranked.end(), [&](const AnsweredEffect& each) {
            return is_statement(each) && each.presence() >= named_from &&
                   truth.causes.count(each.effect) == 0;
        });
    }
    bool first_is_right() const {
        const std::string first = ranked.empty() ? "none" : ranked.front().effect;
        return truth.causes.empty() ? first == "none" : truth.causes.count(first) > 0;
    }
    bool is_right(const AnsweredEffect& each) const {
        return each.effect == "none" ? truth.causes.empty() : truth.causes.count(each.effect) > 0;
    }
};

void count_case(const Said& said, CauseGroup& group) {
    for (const std::string& effect : said.truth.causes) group.recall.count(said.names(effect));
    if (!said.truth.causes.empty()) group.all_named.count(said.names_all());
    group.first.count(said.first_is_right());
    group.false_names.count(said.names_what_is_not_there());
}

void count_conditions(const Said& said, const CaseLabel& label, CausesScore& score) {
    for (const AnsweredEffect& each : said.ranked) {
        if (!is_statement(each) || each.presence() < named_from) continue;
        const auto cause = std::find_if(label.causes.begin(), label.causes.end(),
                                        [&](const TrueCause& truth) { return truth.effect == each.effect; });
        if (cause != label.causes.end() && !cause->varies.empty()) {
            score.varies.count(each.varies == cause->varies);
        } else {
            score.false_varies.count(!each.varies.empty());
        }
    }
}

// The mean distance of a binomial number from its mean (de Moivre 1730).
double mean_deviation(int of, double probability) {
    if (probability <= 0.0 || probability >= 1.0) return 0.0;
    const double n = of;
    const double above = std::floor(n * probability) + 1.0;  // the least number above the mean
    return 2.0 * std::exp(above * std::log(probability) + (n - above + 1.0) * std::log1p(-probability) +
                          std::log(above) + std::lgamma(n + 1.0) - std::lgamma(above + 1.0) -
                          std::lgamma(n - above + 1.0));
}

}  // namespace

CaseTruth truth_of(const CaseLabel& label) {
    CaseTruth truth;
    for (const TrueCause& cause : label.causes) truth.causes.insert(cause.effect);
    for (const Nuisance& nuisance : label.nuisances) {
        if (truth.causes.count(nuisance.effect) == 0) truth.nuisances.insert(nuisance.effect);
    }
    return truth;
}

std::vector<AnsweredEffect> judged(const CaseAnswer& answer, const CaseTruth& truth) {
    std::vector<AnsweredEffect> ranked;
    double of_nuisances = 0.0;
    for (const AnsweredEffect& each : answer.ranked) {
        if (truth.nuisances.count(each.effect) > 0 && each.varies.empty()) {
            of_nuisances += each.probability;
        } else {
            ranked.push_back({each.effect, each.probability, each.presence(), each.varies});
        }
    }
    if (of_nuisances > 0.0 && of_nuisances < 1.0) {
        for (AnsweredEffect& each : ranked) each.probability /= 1.0 - of_nuisances;
    }
    return ranked;
}

void Reliability::add(double stated, bool is_right) {
    const int count = static_cast<int>(sums_.size());
    const int index = std::clamp(static_cast<int>(stated * count), 0, count - 1);
    ReliabilityBin& bin = sums_[static_cast<std::size_t>(index)];
    bin.from = static_cast<double>(index) / count;
    bin.to = static_cast<double>(index + 1) / count;
    bin.mean_probability += stated;  // their sum until bins() divides it
    bin.right.count(is_right);
}

std::vector<ReliabilityBin> Reliability::bins() const {
    std::vector<ReliabilityBin> filled;
    for (ReliabilityBin bin : sums_) {
        if (bin.right.of == 0) continue;
        bin.mean_probability /= bin.right.of;
        filled.push_back(bin);
    }
    return filled;
}

double Reliability::calibration_error() const {
    double statements = 0.0;
    double sum = 0.0;
    for (const ReliabilityBin& bin : bins()) {
        statements += bin.right.of;
        sum += std::abs(bin.mean_probability - bin.right.value()) * bin.right.of;
    }
    return statements > 0.0 ? sum / statements : 0.0;
}

double Reliability::calibration_error_by_chance() const {
    double statements = 0.0;
    double sum = 0.0;
    for (const ReliabilityBin& bin : bins()) {
        statements += bin.right.of;
        sum += mean_deviation(bin.right.of, bin.mean_probability);
    }
    return statements > 0.0 ? sum / statements : 0.0;
}

CausesScore score_causes(const std::vector<NamedCase>& cases) {
    CausesScore score;
    Groups groups;
    groups.of("all", "all cases");
    Reliability reliability;
    for (const NamedCase& each : cases) {
        const CaseLabel& label = *each.label;
        const CaseTruth truth = truth_of(label);
        const Said said{truth, judged(*each.answer, truth)};
        count_case(said, groups.of("all", "all cases"));
        count_case(said, groups.of("causes", std::to_string(truth.causes.size())));
        count_case(said, groups.of("bench", label.bench));
        for (const TrueCause& cause : label.causes) {
            groups.of("visibility", visibility_band(cause.visibility)).recall.count(said.names(cause.effect));
            groups.of("effect", cause.effect).recall.count(said.names(cause.effect));
        }
        if (!truth.causes.empty() && truth.causes.count("unknown") == 0)
            score.unknown.count(said.names("unknown"));
        count_conditions(said, label, score);
        for (const AnsweredEffect& stated : said.ranked) {
            if (stated.presence() >= stated_from) reliability.add(stated.presence(), said.is_right(stated));
        }
    }
    score.groups = groups.take();
    score.reliability = reliability.bins();
    score.calibration_error = reliability.calibration_error();
    score.calibration_error_by_chance = reliability.calibration_error_by_chance();
    return score;
}

}  // namespace capstan::gap_trial
