#include "capstan/gap_trial/nuisances.h"

#include <cmath>

#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

struct Sizes {
    double motor_zero_Nm = 0.0;
    double load_zero_Nm = 0.0;
    double motor_friction_Nm = 0.0;
    double load_friction_Nm = 0.0;
};

Sizes draw_sizes(const Rig& rig, TrialStream& draws) {
    Sizes sizes;
    if (rig.bench.is_drive()) {
        // As a surgical grasper's drive: its motor sensor's zero is -8 to -12 mN m, its constant friction 28
        // to 43 mN m.
        sizes.motor_zero_Nm = draws.log_uniform(2e-3, 0.015);
        sizes.load_zero_Nm = draws.log_uniform(5e-4, 3e-3);
        sizes.motor_friction_Nm = draws.log_uniform(3e-3, 0.04);
        sizes.load_friction_Nm = draws.log_uniform(1e-3, 8e-3);
        return sizes;
    }
    const double motor_Nm = rig.motor_torque_scale_Nm();
    const double load_Nm = rig.load_torque_scale_Nm();
    sizes.motor_zero_Nm = motor_Nm * draws.uniform(0.005, 0.03);
    sizes.load_zero_Nm = load_Nm * draws.uniform(0.005, 0.03);
    sizes.motor_friction_Nm = motor_Nm * draws.uniform(0.005, 0.04);
    sizes.load_friction_Nm = load_Nm * draws.uniform(0.005, 0.03);
    return sizes;
}

}  // namespace

std::vector<Nuisance> add_nuisances(const Rig& rig, TrueEffects& effects, TrialStream& draws) {
    const Sizes sizes = draw_sizes(rig, draws);
    std::vector<Nuisance> nuisances;
    const auto add_zero = [&](const std::string& channel, double size) {
        nuisances.push_back({"sensor_offset", channel, draws.sign() * size});
        effects.sensors[channel].offset += nuisances.back().size;
    };
    add_zero(channel::motor_torque, sizes.motor_zero_Nm);
    add_zero(channel::load_torque, sizes.load_zero_Nm);
    for (const TensionSensor& sensor : rig.bench.tension_sensors)
        add_zero(sensor.channel, rig.pretension_N * draws.uniform(0.02, 0.08));
    nuisances.push_back({"pulley_friction", "motor", sizes.motor_friction_Nm});
    effects.motor_bearing.coulomb_Nm += sizes.motor_friction_Nm;
    // A held end does not turn.
    if (!rig.bench.is_pair()) return nuisances;
    nuisances.push_back({"pulley_friction", "load", sizes.load_friction_Nm});
    effects.load_bearing.coulomb_Nm += sizes.load_friction_Nm;
    return nuisances;
}

std::vector<Nuisance> add_wrong_nominals(TrueEffects& effects, TrialStream& draws) {
    std::vector<Nuisance> nuisances;
    const auto add = [&](const char* name, double& ratio) {
        const double size = draws.sign() * draws.uniform(std::log(1.07), std::log(1.20));
        ratio *= std::exp(size);
        nuisances.push_back({name, "", size});
    };
    add("param_mu", effects.friction_ratio);
    add("param_K", effects.stiffness_ratio);
    add("param_T0", effects.pretension_ratio);
    return nuisances;
}

}  // namespace capstan::gap_trial
