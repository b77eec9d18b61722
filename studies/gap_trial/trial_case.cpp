#include "capstan/gap_trial/trial_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace capstan::gap_trial {

namespace {

constexpr int max_attempts = 200;

// A bench and its session before any effect.
struct Setup {
    TrialBench bench;
    std::vector<TrialRun> runs;
    TrueEffects effects;
    std::vector<TrueRun> truth;
    SensedSession sensed;
    std::vector<Nuisance> nuisances;
};

bool all_fit(const PlannedCase& planned, const Setup& setup) {
    return std::all_of(planned.makers.begin(), planned.makers.end(),
                       [&](const EffectMaker& maker) { return fits(maker, setup.bench, setup.runs); });
}

Setup draw_setup(const TrialOptions& options, CaseStreams& draws) {
    Setup setup;
    const BenchKind kind =
        all_bench_kinds[draws.bench.integer_below(static_cast<int>(std::size(all_bench_kinds)))];
    setup.bench = make_trial_bench(kind, options.noise_factor, draws.bench);
    setup.runs = draw_session(setup.bench, options.length, draws.motion);
    setup.effects.friction_ratio = std::exp(options.nominal_error * draws.nominal.normal());
    setup.effects.stiffness_ratio = std::exp(options.nominal_error * draws.nominal.normal());
    setup.effects.pretension_ratio = std::exp(options.nominal_error * draws.nominal.normal());
    if (options.nuisances)
        setup.nuisances =
            add_nuisances({setup.bench, setup.runs.front().pretension_N}, setup.effects, draws.nuisance);
    return setup;
}

// Adds each effect at its severity, measured alone; none if one of them cannot reach it on this bench.
std::optional<std::vector<TrueCause>> add_effects(const PlannedCase& planned, const TrialOptions& options,
                                                  const Setup& setup, CaseStreams& draws, TrueEffects& all) {
    const std::map<std::string, double> spans = spans_of(setup.bench, setup.sensed);
    const EffectSetting setting{setup.bench, setup.runs, spans};
    if (planned.makers.empty()) return std::vector<TrueCause>{};
    const Baseline baseline = make_baseline(setup.bench, setup.runs, setup.effects, setup.sensed);
    const EffectTrial trial{setup.bench, setup.runs, setup.effects,
                            setup.truth, baseline,   {.zeros_float = options.nuisances}};
    const VisibilityRange range = range_of(planned.severity);
    std::vector<TrueCause> causes;
    for (const EffectMaker& maker : planned.makers) {
        const WithheldEffect effect = maker.draw(setting, draws.effect);
        const double wanted =
            options.visibility ? draws.effect.log_uniform(options.visibility->low, options.visibility->high)
                               : draws.effect.log_uniform(1.1 * range.low, range.high / 1.1);
        const auto sized = find_size(trial, effect, options.visibility ? around(wanted) : range, wanted);
        if (!sized) return std::nullopt;
        effect.apply(all, sized->size);
        causes.push_back(as_cause(effect, *sized));
    }
    return causes;
}

}  // namespace

CaseStreams::CaseStreams(std::uint64_t seed, int index)
    : bench(seed, index, DrawTopic::bench),
      motion(seed, index, DrawTopic::motion),
      effect(seed, index, DrawTopic::effect),
      noise(seed, index, DrawTopic::noise),
      nominal(seed, index, DrawTopic::nominal_error),
      nuisance(seed, index, DrawTopic::nuisance) {}

std::map<std::string, double> spans_of(const TrialBench& bench, const SensedSession& session) {
    std::map<std::string, double> spans;
    const std::vector<std::string> channels = bench.channels();
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        for (const SensedRun& run : session) {
            const auto [low, high] = std::minmax_element(run[channel].begin(), run[channel].end());
            double& span = spans[channels[channel]];
            span = std::max(span, *high - *low);
        }
    }
    return spans;
}

TrueCause as_cause(const WithheldEffect& effect, const SizedEffect& sized) {
    return {effect.effect,
            effect.kind,
            effect.component,
            effect.end,
            effect.where,
            effect.size_name,
            sized.size,
            effect.shape,
            sized.visibility.ratio,
            sized.visibility.channel,
            effect.varies};
}

bool is_finite(const SensedSession& session) {
    for (const SensedRun& run : session) {
        for (const std::vector<double>& channel : run) {
            for (const double value : channel) {
                if (!std::isfinite(value)) return false;
            }
        }
    }
    return true;
}

VisibilityRange around(double visibility) {
    constexpr double close = 1.2;
    return {visibility / close, visibility * close};
}

CaseLabel make_case(const PlannedCase& planned, const TrialOptions& options,
                    const std::filesystem::path& folder) {
    CaseStreams draws(options.seed, planned.index);
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
        Setup setup = draw_setup(options, draws);
        if (!all_fit(planned, setup)) continue;
        setup.truth = run_session(setup.bench, setup.runs, setup.effects);
        setup.sensed = sense_session(setup.bench, setup.truth, setup.effects);
        TrueEffects effects = setup.effects;
        const auto causes = add_effects(planned, options, setup, draws, effects);
        if (!causes) continue;
        const SensedSession sensed =
            causes->empty()
                ? setup.sensed
                : sense_session(setup.bench, run_session(setup.bench, setup.runs, effects), effects);
        if (!is_finite(sensed)) continue;
        std::vector<SensedRun> logged;
        for (const SensedRun& run : sensed)
            logged.push_back(with_noise(setup.bench, run, effects.sensors, draws.noise));
        write_recording(folder, planned.name, setup.bench, setup.runs, logged);

        CaseLabel label;
        label.name = planned.name;
        label.group = planned.group;
        if (planned.group != TruthGroup::none) label.severity = planned.severity;
        if (options.visibility) label.severity.reset();
        label.bench = bench_kind_name(setup.bench.kind);
        for (const TrialRun& run : setup.runs) label.protocols.push_back(run.protocol);
        label.causes = *causes;
        label.friction_ratio = effects.friction_ratio;
        label.stiffness_ratio = effects.stiffness_ratio;
        label.pretension_ratio = effects.pretension_ratio;
        label.nuisances = setup.nuisances;
        return label;
    }
    throw std::runtime_error(fmt::format(
        "{}: no drawn bench shows {} at this severity after {} attempts; try another "
        "seed, severity or noise",
        planned.name, planned.makers.empty() ? "nothing" : planned.makers.front().effect, max_attempts));
}

}  // namespace capstan::gap_trial
