#include "capstan/gap_trial/trial_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "capstan/effects/known_causes.h"

namespace capstan::gap_trial {

namespace {

constexpr double none_fraction = 0.10;
constexpr double foreign_fraction = 0.12;
constexpr double parameter_fraction = 0.09;
// The address of draws for the trial itself; no case has it.
constexpr int trial_address = 0x7fffffff;

template <typename Item>
void shuffle(std::vector<Item>& items, TrialStream& draws) {
    for (std::size_t k = items.size(); k > 1; --k)
        std::swap(items[k - 1], items[static_cast<std::size_t>(draws.integer_below(static_cast<int>(k)))]);
}

void number_cases(std::vector<PlannedCase>& plan, TrialStream& draws) {
    shuffle(plan, draws);
    for (std::size_t k = 0; k < plan.size(); ++k) {
        plan[k].index = static_cast<int>(k) + 1;
        plan[k].name = case_name(plan[k].index);
    }
}

int causes_of(TruthGroup group) {
    switch (group) {
        case TruthGroup::none:
            return 0;
        case TruthGroup::catalogue:
        case TruthGroup::parameter:
        case TruthGroup::foreign:
            return 1;
        case TruthGroup::mixture:
            return 2;
        case TruthGroup::three:
            return 3;
    }
    return 0;
}

// Deals items one after the other in a random order, and then again.
class Round {
  public:
    Round(std::vector<EffectMaker> makers, TrialStream& draws) : makers_(std::move(makers)) {
        shuffle(makers_, draws);
    }
    const EffectMaker& next() { return makers_[turn_++ % makers_.size()]; }
    /// How often the round has been gone through.
    std::size_t rounds() const { return turn_ / makers_.size(); }

  private:
    std::vector<EffectMaker> makers_;
    std::size_t turn_ = 0;
};

// What a bench with nuisances has anyway cannot be its cause. Where --severity holds, the first forms of the
// effects stay, so that the seeds of such trials keep their bits.
std::vector<EffectMaker> named_effects(const TrialOptions& options) {
    if (!options.visibility && !options.nuisances) return catalogue_effects();
    std::vector<EffectMaker> makers = with_own_forms(catalogue_effects());
    if (options.nuisances)
        std::erase_if(makers, [](const EffectMaker& maker) {
            return maker.effect == "sensor_offset" || maker.effect == "pulley_friction";
        });
    return makers;
}

Severity severity_of(SeverityChoice choice, std::size_t turn) {
    if (choice == SeverityChoice::mild) return Severity::mild;
    if (choice == SeverityChoice::strong) return Severity::strong;
    return turn % 2 == 0 ? Severity::strong : Severity::mild;
}

}  // namespace

std::string severity_choice_name(SeverityChoice choice) {
    switch (choice) {
        case SeverityChoice::mild:
            return "mild";
        case SeverityChoice::strong:
            return "strong";
        case SeverityChoice::both:
            return "both";
    }
    return "";
}

std::string length_name(RecordingLength length) {
    return length == RecordingLength::standard ? "standard" : "short";
}

std::string trial_kind_name(TrialKind kind) {
    return kind == TrialKind::benches ? "benches" : "rigs";
}

void add_options(nlohmann::ordered_json& json, const TrialOptions& options) {
    json["seed"] = options.seed;
    json["severity"] = severity_choice_name(options.severity);
    json["noise_factor"] = options.noise_factor;
    json["length"] = length_name(options.length);
    json["nominal_error"] = options.nominal_error;
    if (options.kind != TrialKind::benches) json["kind"] = trial_kind_name(options.kind);
    if (options.visibility) json["visibility"] = {options.visibility->low, options.visibility->high};
    if (options.nuisances) json["nuisances"] = true;
    if (options.mixtures != TrialOptions().mixtures) json["mixtures"] = options.mixtures;
    if (options.only) json["only"] = truth_group_name(*options.only);
}

std::string options_text(const TrialOptions& options) {
    nlohmann::ordered_json json = {{"cases", options.cases}};
    add_options(json, options);
    return json.dump(1) + "\n";
}

std::string case_name(int number) {
    return fmt::format("case{:03}", number);
}

std::string truth_group_name(TruthGroup group) {
    switch (group) {
        case TruthGroup::none:
            return "none";
        case TruthGroup::catalogue:
            return "one effect";
        case TruthGroup::parameter:
            return "wrong parameter";
        case TruthGroup::foreign:
            return "outside the catalogue";
        case TruthGroup::mixture:
            return "two effects";
        case TruthGroup::three:
            return "three effects";
    }
    return "";
}

std::optional<TruthGroup> truth_group_named(std::string_view name) {
    for (const TruthGroup group : {TruthGroup::none, TruthGroup::catalogue, TruthGroup::parameter,
                                   TruthGroup::foreign, TruthGroup::mixture, TruthGroup::three}) {
        if (truth_group_name(group) == name) return group;
    }
    return std::nullopt;
}

bool fits(const EffectMaker& maker, const TrialBench& bench, const std::vector<TrialRun>& runs) {
    if (maker.needs_pair && !bench.is_pair()) return false;
    if (!maker.needs_motion) return true;
    return std::any_of(runs.begin(), runs.end(),
                       [](const TrialRun& run) { return run.output == OutputKind::handle; });
}

std::string effect_family(const std::string& effect) {
    const KnownCause* known = find_cause(effect);
    return known != nullptr ? known->family : effect;
}

std::vector<PlannedCase> plan_trial(const TrialOptions& options) {
    TrialStream draws(options.seed, trial_address, DrawTopic::plan);
    const std::vector<EffectMaker> effects = named_effects(options);
    Round catalogue(effects, draws);
    Round parameters(wrong_parameters(), draws);
    Round foreign(foreign_causes(), draws);
    Round firsts(effects, draws);
    Round seconds(effects, draws);
    const auto number_of = [&](TruthGroup group, double fraction) {
        if (options.only) return *options.only == group ? options.cases : 0;
        return static_cast<int>(std::lround(fraction * options.cases));
    };

    std::vector<PlannedCase> plan;
    const auto add = [&](TruthGroup group, Severity severity, std::vector<EffectMaker> makers) {
        plan.push_back({0, "", group, severity, std::move(makers)});
    };
    for (int k = number_of(TruthGroup::none, none_fraction); k > 0; --k)
        add(TruthGroup::none, Severity::strong, {});
    for (int k = number_of(TruthGroup::foreign, foreign_fraction); k > 0; --k)
        add(TruthGroup::foreign, severity_of(options.severity, plan.size()), {foreign.next()});
    for (int k = number_of(TruthGroup::parameter, parameter_fraction); k > 0; --k)
        add(TruthGroup::parameter, severity_of(options.severity, plan.size()), {parameters.next()});
    for (int k = number_of(TruthGroup::mixture, options.mixtures); k > 0; --k) {
        const EffectMaker& first = firsts.next();
        const EffectMaker* second = &seconds.next();
        while (effect_family(second->effect) == effect_family(first.effect)) second = &seconds.next();
        add(TruthGroup::mixture, options.severity == SeverityChoice::mild ? Severity::mild : Severity::strong,
            {first, *second});
    }
    while (static_cast<int>(plan.size()) < options.cases) {
        // Each effect alternates from round to round, and half of them begin mild.
        const std::size_t turn = catalogue.rounds() + plan.size();
        add(TruthGroup::catalogue, severity_of(options.severity, turn), {catalogue.next()});
    }
    number_cases(plan, draws);
    return plan;
}

std::vector<PlannedCase> plan_rigs(const TrialOptions& options) {
    TrialStream draws(options.seed, trial_address, DrawTopic::plan);
    std::vector<PlannedCase> plan(static_cast<std::size_t>(options.cases));
    // Each property is dealt in its proportion, and then shuffled on its own.
    const auto deal = [&](const auto& set) {
        shuffle(plan, draws);
        for (std::size_t k = 0; k < plan.size(); ++k)
            set(plan[k], (static_cast<double>(k) + 0.5) / static_cast<double>(plan.size()));
    };
    deal([&](PlannedCase& each, double at) {
        each.group = at < 0.10   ? TruthGroup::none
                     : at < 0.45 ? TruthGroup::catalogue
                     : at < 0.75 ? TruthGroup::mixture
                                 : TruthGroup::three;
        if (options.only) each.group = *options.only;
        each.causes = causes_of(each.group);
    });
    deal([](PlannedCase& each, double at) {
        each.bench = at < 1.0 / 3.0   ? BenchKind::rig_drive
                     : at < 5.0 / 6.0 ? BenchKind::rig_pair
                                      : BenchKind::rig_single;
    });
    deal([](PlannedCase& each, double at) {
        each.has_conditions = at < 0.4;
        each.varies = at < 0.2 && each.causes > 0;
    });
    number_cases(plan, draws);
    return plan;
}

}  // namespace capstan::gap_trial
