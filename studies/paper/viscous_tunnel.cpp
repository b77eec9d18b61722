#include "capstan/paper/viscous_tunnel.h"

#include <cmath>

#include "capstan/paper/error_reduction_tunnel.h"
#include "capstan/rig/bench_simulation.h"
#include "capstan/sensing/random_stream.h"

namespace capstan::paper {

namespace {

struct TorqueRun {
    std::vector<double> load_torque_Nm;  // samples
    std::vector<double> motor_angle_rad;
    int unsolved_steps = 0;
};

struct Tunnel {
    PullPull pair;
    double time_step_s = 0.0;
    int steps = 0;

    TorqueRun run(const BenchEffects& effects) const {
        BenchSimulation bench({.cable = pair.cable_a(), .pulleys = pair.pulleys()}, effects);
        TorqueRun run;
        for (int step = 1; step <= steps; ++step) {
            const double time_s = step * time_step_s;
            const double angle_rad = handle_angle_rad(time_s);
            const BenchInputs inputs{MotorTorque{tunnel_torque_Nm(angle_rad)}, LoadAngle{angle_rad},
                                     time_step_s, time_s};
            if (!bench.advance(inputs).converged) ++run.unsolved_steps;
            run.load_torque_Nm.push_back(bench.load_torque_Nm());
            run.motor_angle_rad.push_back(bench.motor_angle_rad());
        }
        return run;
    }
    TorqueRun model(double drag_N_s_per_m2) const {
        BenchEffects effects;
        effects.of<ViscousFriction>().drag_N_s_per_m2 = drag_N_s_per_m2;
        return run(effects);
    }
};

BenchEffects effects_of(const ViscousBench& bench, double conduit_m) {
    BenchEffects effects;
    effects.of<ViscousFriction>().drag_N_s_per_m2 = bench.drag_N_s_per_m2;
    effects.of<PulleyFriction>().load.coulomb_Nm = bench.load_friction_Nm;
    // Typical, as the effects' catalogue says: 1 rad of wrap per rad of handle, 5 mN m of cogging.
    effects.of<MovingBend>() = {.extra_angle_per_load_angle = bench.remainder * 1.0,
                                .middle_m = conduit_m - 0.15};
    effects.of<MotorCogging>() = {.sine_Nm = bench.remainder * 0.005, .cosine_Nm = bench.remainder * 0.005};
    return effects;
}

void add_noise(std::vector<double>& torque_Nm, double deviation_Nm) {
    for (std::size_t k = 0; k < torque_Nm.size(); ++k) {
        RandomAddress address;
        address.node = static_cast<std::uint32_t>(k);
        torque_Nm[k] += deviation_Nm * standard_normals(address)[0];
    }
}

// The drag of least squares by Gauss and Newton: the torque is nearly linear in it, so a few steps do.
double fitted_drag(const Tunnel& tunnel, const std::vector<double>& bench_Nm) {
    constexpr double difference = 0.5;
    constexpr double near_enough = 0.01;
    double drag = 0.0;
    for (int iteration = 0; iteration < 6; ++iteration) {
        const auto here_Nm = tunnel.model(drag).load_torque_Nm;
        const auto there_Nm = tunnel.model(drag + difference).load_torque_Nm;
        double slope_squares = 0.0;
        double slope_residual = 0.0;
        for (std::size_t k = 0; k < bench_Nm.size(); ++k) {
            const double slope = (there_Nm[k] - here_Nm[k]) / difference;
            slope_squares += slope * slope;
            slope_residual += slope * (bench_Nm[k] - here_Nm[k]);
        }
        const double change = slope_residual / slope_squares;
        drag = std::max(0.0, drag + change);
        if (std::abs(change) < near_enough) break;
    }
    return drag;
}

ResidualLine residual_line(const std::vector<ViscousSample>& samples, double ViscousSample::*model_Nm) {
    const auto count = static_cast<double>(samples.size());
    double speed = 0.0, residual = 0.0, speed_squares = 0.0, products = 0.0, squares = 0.0;
    for (const ViscousSample& sample : samples) {
        const double left_Nm = sample.bench_torque_Nm - sample.*model_Nm;
        speed += sample.load_speed_rad_per_s;
        residual += left_Nm;
        speed_squares += sample.load_speed_rad_per_s * sample.load_speed_rad_per_s;
        products += sample.load_speed_rad_per_s * left_Nm;
        squares += left_Nm * left_Nm;
    }
    ResidualLine line;
    line.slope_Nm_s_per_rad = (products - speed * residual / count) / (speed_squares - speed * speed / count);
    line.offset_Nm = (residual - line.slope_Nm_s_per_rad * speed) / count;
    line.sum_of_squares_Nm2 = squares;
    line.rms_Nm = std::sqrt(squares / count);
    return line;
}

}  // namespace

ViscousComparison compare_viscous_models(const CableSetting& setting, double pretension_N,
                                         const ViscousBench& bench, const Resolution& resolution) {
    const int steps = static_cast<int>(std::lround(2.0 * handle_period_s / resolution.time_step_s));
    const Tunnel tunnel{paper_bench(setting, pretension_N, resolution.segments), resolution.time_step_s,
                        steps};
    TorqueRun measured = tunnel.run(effects_of(bench, tunnel.pair.cable_a().length_m()));
    add_noise(measured.load_torque_Nm, bench.torque_noise_Nm);

    ViscousComparison comparison{setting.name, pretension_N, bench, 0.0, {}, {}, {}, 0};
    comparison.fitted_drag_N_s_per_m2 = fitted_drag(tunnel, measured.load_torque_Nm);
    const TorqueRun without = tunnel.model(0.0);
    const TorqueRun with = tunnel.model(comparison.fitted_drag_N_s_per_m2);
    for (int step = 1; step <= steps; ++step) {
        const double time_s = step * resolution.time_step_s;
        const double half_s = 0.5 * resolution.time_step_s;
        const double turned_rad = handle_angle_rad(time_s + half_s) - handle_angle_rad(time_s - half_s);
        const double angle_rad = handle_angle_rad(time_s);
        const auto at = static_cast<std::size_t>(step - 1);
        comparison.samples.push_back({time_s, angle_rad, turned_rad / resolution.time_step_s,
                                      tunnel_torque_Nm(angle_rad), measured.load_torque_Nm[at],
                                      measured.motor_angle_rad[at], without.load_torque_Nm[at],
                                      with.load_torque_Nm[at]});
    }
    comparison.without_term = residual_line(comparison.samples, &ViscousSample::without_term_Nm);
    comparison.with_term = residual_line(comparison.samples, &ViscousSample::with_term_Nm);
    comparison.unsolved_steps = measured.unsolved_steps + without.unsolved_steps + with.unsolved_steps;
    return comparison;
}

Recording recorded_bench(const CableSetting& setting, const ViscousComparison& comparison) {
    constexpr double motor_step_rad = 7.85e-4;
    const PullPull pair = paper_bench(setting, comparison.pretension_N, 1);
    const Cable& cable = pair.cable_a();
    Recording recording;
    recording.name = "exp2";
    recording.sample_rate_Hz = 1.0 / (comparison.samples[1].time_s - comparison.samples[0].time_s);
    recording.channels = {{"motor_torque", "N m", {}, {}},
                          {"motor_angle", "rad", {}, motor_step_rad},
                          {"load_angle", "rad", {}, {}},
                          {"load_torque", "N m", comparison.bench.torque_noise_Nm, {}}};
    recording.nominal = NominalBench{.curvature = {{cable.length_m(), setting.bend_radius_m}},
                                     .motor_radius_m = pair.pulleys().motor_radius_m,
                                     .load_radius_m = pair.pulleys().load_radius_m,
                                     .axial_stiffness_N = cable.axial_stiffness_N(),
                                     .dynamic_friction = cable.dynamic_friction(),
                                     .static_friction = cable.static_friction()};
    RecordedRun run;
    run.number = 1;
    run.protocol = "exp2";
    run.pretension_N = comparison.pretension_N;
    run.output = OutputKind::handle;
    run.driven = {"motor_torque", "load_angle"};
    run.values.resize(recording.channels.size());
    // What the instruments resolve.
    const auto to_fraction = [](double value, double of_unit) {
        return std::round(value * of_unit) / of_unit;
    };
    for (const ViscousSample& sample : comparison.samples) {
        const double steps = std::round(sample.bench_motor_angle_rad / motor_step_rad);
        run.time_s.push_back(to_fraction(sample.time_s, 1e3));
        run.values[0].push_back(to_fraction(sample.motor_torque_Nm, 1e6));
        run.values[1].push_back(to_fraction(steps * motor_step_rad, 1e6));
        run.values[2].push_back(to_fraction(sample.load_angle_rad, 1e6));
        run.values[3].push_back(to_fraction(sample.bench_torque_Nm, 1e5));
    }
    recording.runs.push_back(std::move(run));
    return recording;
}

}  // namespace capstan::paper
