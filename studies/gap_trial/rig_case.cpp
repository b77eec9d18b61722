#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "capstan/gap_trial/rig_effects.h"
#include "capstan/gap_trial/rig_motion.h"
#include "capstan/gap_trial/trial_case.h"

namespace capstan::gap_trial {

namespace {

constexpr int max_rigs = 12;
// Drawn again where the rig cannot show one.
constexpr int max_draws_of_cause = 12;
constexpr VisibilityRange rig_visibility{0.5, 10.0};
// Sizes are found with fewer masses than the recording is made with.
constexpr LumpedBenchOptions sizing = rig_simulation(24);
constexpr LumpedBenchOptions recorded = rig_simulation(48);
constexpr NominalFreedom wrong_by_20_percent{std::log(1.2), true};

struct RunCondition {
    const char* name;
    double step;
    int max_steps;  ///< to both sides
};
constexpr RunCondition run_conditions[] = {
    {"roll_deg", 45.0, 2}, {"wrist_deg", 15.0, 4}, {"bend_deg", 30.0, 3}, {"temperature_offset_K", 5.0, 3}};

// Each run another value of the condition.
std::string set_condition(std::vector<TrialRun>& runs, TrialStream& draws) {
    const RunCondition& condition =
        run_conditions[draws.integer_below(static_cast<int>(std::size(run_conditions)))];
    std::vector<int> steps;
    for (int step = -condition.max_steps; step <= condition.max_steps; ++step) steps.push_back(step);
    for (TrialRun& run : runs) {
        const auto chosen = steps.begin() + draws.integer_below(static_cast<int>(steps.size()));
        run.conditions[condition.name] = *chosen * condition.step;
        steps.erase(chosen);
    }
    return condition.name;
}

struct RigSetup {
    Rig rig;
    std::vector<TrialRun> runs;
    std::string condition;  ///< empty: none
    TrueEffects effects;    ///< wrong nominal numbers and nuisances
    std::vector<Nuisance> nuisances;
};

RigSetup draw_rig_setup(const PlannedCase& planned, const TrialOptions& options, CaseStreams& draws) {
    RigSetup setup;
    setup.rig = draw_rig(planned.bench, options.noise_factor, draws.bench);
    const int runs =
        planned.has_conditions ? 2 + draws.motion.integer_below(4) : 1 + draws.motion.integer_below(4);
    setup.runs = draw_rig_session(setup.rig, runs, draws.motion);
    if (planned.has_conditions) setup.condition = set_condition(setup.runs, draws.motion);
    if (setup.rig.bench.is_drive()) {
        // Nothing is stated that could be wrong, so a wrong number explains nothing.
        setup.nuisances = {{"param_mu", "", 0.0}, {"param_K", "", 0.0}, {"param_T0", "", 0.0}};
    } else {
        setup.nuisances = add_wrong_nominals(setup.effects, draws.nominal);
    }
    for (const Nuisance& nuisance : add_nuisances(setup.rig, setup.effects, draws.nuisance))
        setup.nuisances.push_back(nuisance);
    return setup;
}

bool is_named(const std::vector<TrueCause>& causes, const std::string& effect) {
    return std::any_of(causes.begin(), causes.end(), [&](const TrueCause& cause) {
        return effect_family(cause.effect) == effect_family(effect);
    });
}

// One more cause that this rig can show at a drawn visibility; none after some draws.
std::optional<TrueCause> add_cause(const RigSetup& setup, const EffectTrial& trial,
                                   const EffectSetting& setting, bool varies, const VisibilityRange& range,
                                   const std::vector<TrueCause>& causes, TrialStream& draws,
                                   TrueEffects& all) {
    std::vector<EffectMaker> makers = rig_effects(setup.rig.bench.kind);
    std::erase_if(makers, [&](const EffectMaker& maker) {
        return !fits(maker, setup.rig.bench, setup.runs) || is_named(causes, maker.effect);
    });
    for (int attempt = 0; attempt < max_draws_of_cause; ++attempt) {
        const EffectMaker& maker =
            makers[static_cast<std::size_t>(draws.integer_below(static_cast<int>(makers.size())))];
        const WithheldEffect effect =
            varies ? draw_varying_number(setting, setup.condition, draws) : maker.draw(setting, draws);
        const double wanted = draws.log_uniform(range.low, range.high);
        const auto sized = find_size(trial, effect, around(wanted), wanted);
        if (!sized) continue;
        effect.apply(all, sized->size);
        return as_cause(effect, *sized);
    }
    return std::nullopt;
}

std::optional<std::vector<TrueCause>> add_causes(const PlannedCase& planned, const TrialOptions& options,
                                                 const RigSetup& setup, TrialStream& draws,
                                                 TrueEffects& all) {
    std::vector<TrueCause> causes;
    if (planned.causes == 0) return causes;
    const TrialBench& bench = setup.rig.bench;
    const std::vector<TrueRun> truth = run_session(bench, setup.runs, setup.effects, sizing);
    const SensedSession sensed = sense_session(bench, truth, setup.effects);
    if (!is_finite(sensed)) return std::nullopt;
    const std::map<std::string, double> spans = spans_of(bench, sensed);
    const EffectSetting setting{bench, setup.runs, spans};
    const Baseline baseline = make_baseline(bench, setup.runs, setup.effects, sensed, sizing);
    const EffectTrial trial{bench, setup.runs, setup.effects, truth, baseline, wrong_by_20_percent, sizing};
    while (std::ssize(causes) < planned.causes) {
        const bool varies = planned.varies && causes.empty();
        const auto cause = add_cause(setup, trial, setting, varies,
                                     options.visibility.value_or(rig_visibility), causes, draws, all);
        if (!cause) return std::nullopt;
        causes.push_back(*cause);
    }
    // The most visible cause first.
    std::sort(causes.begin(), causes.end(),
              [](const TrueCause& a, const TrueCause& b) { return a.visibility > b.visibility; });
    return causes;
}

CaseLabel label_of(const PlannedCase& planned, const RigSetup& setup, const TrueEffects& effects,
                   std::vector<TrueCause> causes) {
    CaseLabel label;
    label.name = planned.name;
    label.group = planned.group;
    label.bench = bench_kind_name(setup.rig.bench.kind);
    for (const TrialRun& run : setup.runs) label.protocols.push_back(run.protocol);
    label.causes = std::move(causes);
    label.friction_ratio = effects.friction_ratio;
    label.stiffness_ratio = effects.stiffness_ratio;
    label.pretension_ratio = effects.pretension_ratio;
    label.nuisances = setup.nuisances;
    if (!setup.condition.empty()) label.conditions = {setup.condition};
    return label;
}

}  // namespace

CaseLabel make_rig_case(const PlannedCase& planned, const TrialOptions& options,
                        const std::filesystem::path& folder) {
    CaseStreams draws(options.seed, planned.index);
    for (int attempt = 0; attempt < max_rigs; ++attempt) {
        const RigSetup setup = draw_rig_setup(planned, options, draws);
        TrueEffects effects = setup.effects;
        const auto causes = add_causes(planned, options, setup, draws.effect, effects);
        if (!causes) continue;
        const TrialBench& bench = setup.rig.bench;
        const std::vector<TrueRun> truth = run_session(bench, setup.runs, effects, recorded);
        const SensedSession sensed = sense_session(bench, truth, effects);
        if (!is_finite(sensed)) continue;
        std::vector<SensedRun> logged;
        for (const SensedRun& run : sensed)
            logged.push_back(with_noise(bench, run, effects.sensors, draws.noise));
        write_recording(folder, planned.name, bench, setup.runs, logged);
        return label_of(planned, setup, effects, *causes);
    }
    throw std::runtime_error(fmt::format(
        "{}: none of {} drawn rigs shows {} effects at the drawn visibilities; try another seed or --visibility",
        planned.name, max_rigs, planned.causes));
}

}  // namespace capstan::gap_trial
