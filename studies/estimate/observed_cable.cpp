#include "capstan/estimate/observed_cable.h"

#include <string_view>

#include "capstan/estimate/modelled_cable.h"

namespace capstan::estimate {

ObservedCable observed_cable(const bench_model::BenchModel& model, const ObservedBench& observed) {
    RecordedRun now;
    now.conditions = observed.conditions;
    const gap::BenchNumbers numbers = model.numbers().in_run(now);
    const NominalBench& bench = model.description.bench;
    const LocalBend& bend = numbers.effects.of<LocalBend>();
    std::vector<CurvaturePiece> path = bench.curvature;
    if (bend.extra_angle_rad != 0.0 && (bend.cables == BentCables::both || bend.cables == observed.cable))
        path = with_bend(path, bend.stretch().from_m, bend.stretch().to_m, bend.extra_angle_rad);

    std::vector<std::string_view> used = {"local_bend", "pretension_drift"};
    ObservedCable cable{.specification = cable_specification(
                            path,
                            {.dynamic_friction = bench.dynamic_friction * numbers.friction_ratio,
                             .static_friction = bench.static_friction * numbers.friction_ratio,
                             .axial_stiffness_N = bench.axial_stiffness_N * numbers.stiffness_ratio,
                             .pretension_N = observed.pretension_N * numbers.pretension_ratio *
                                             numbers.effects.of<PretensionDrift>().ratio(observed.session_s)},
                            observed.segments),
                        .rate_friction = {},
                        .not_used = {}};
    if (observed.speed_dependent) {
        cable.rate_friction = {numbers.effects.of<ViscousFriction>(), numbers.effects.of<Stribeck>()};
        used.insert(used.end(), {"viscous_friction", "stribeck"});
    }
    std::vector<std::string> stated;
    for (const auto& [name, value] : observed.conditions) stated.push_back(name);
    cable.not_used = parts_not_used(
        model, {.effects = used, .stated_conditions = stated, .sample_rate_Hz = model.sample_rate_Hz});
    return cable;
}

}  // namespace capstan::estimate
