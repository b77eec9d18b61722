#include "capstan/controller/observer.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/ensemble/far_end_process.h"

namespace capstan {

namespace {

std::string in_digits(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

// Between two samples, for the sliding speed; the cable has been at rest for so long before the first one.
constexpr double shortest_interval_s = 1e-9;
constexpr double longest_interval_s = 1e9;

void add_problems_of(const RateFriction& friction, std::vector<std::string>& problems) {
    const auto check = [&](const char* name, double value) {
        if (!(value >= 0.0) || !std::isfinite(value))
            problems.push_back("rate_friction." + std::string(name) + ": is " + in_digits(value) +
                               ", but must be 0 or more");
    };
    check("drag_N_s_per_m2", friction.viscous.drag_N_s_per_m2);
    check("extra_friction", friction.stribeck.extra_friction);
    check("speed_m_per_s", friction.stribeck.speed_m_per_s);
    check("memory_s", friction.stribeck.memory_s);
    if (friction.stribeck.is_active() && friction.stribeck.speed_m_per_s == 0.0)
        problems.push_back("rate_friction.speed_m_per_s: is 0, but must be above 0 with an extra friction");
}

std::vector<std::string> problems_of(const Cable& cable, const std::vector<ObserverSensor>& sensors,
                                     const ObserverSettings& settings) {
    std::vector<std::string> problems;
    int of_the_load = 0;
    for (std::size_t k = 0; k < sensors.size(); ++k) {
        if (sensors[k].is_load_displacement) {
            ++of_the_load;
        } else if (!(sensors[k].place_m >= 0.0 && sensors[k].place_m <= cable.length_m())) {
            problems.push_back("sensors[" + std::to_string(k) + "]: its place is " +
                               in_digits(sensors[k].place_m) + " m, but the cable reaches from 0 to " +
                               in_digits(cable.length_m()) + " m");
        }
    }
    if (of_the_load > 1) problems.push_back("sensors: two measure the displacement of the load; give one");
    if (!(settings.noise_N > 0.0) || !std::isfinite(settings.noise_N))
        problems.push_back("noise_N: is " + in_digits(settings.noise_N) + ", but must be above 0");
    add_problems_of(settings.rate_friction, problems);
    return problems;
}

const Cable& checked(const Cable& cable, const std::vector<ObserverSensor>& sensors,
                     const ObserverSettings& settings) {
    if (auto problems = problems_of(cable, sensors, settings); !problems.empty())
        throw InvalidInput(std::move(problems));
    return cable;
}

}  // namespace

Observer::Observer(const Cable& cable, std::vector<ObserverSensor> sensors, const ObserverSettings& settings)
    : step_(checked(cable, sensors, settings), ModelRules::consistent()),
      start_(pretensioned(step_.cable())),
      estimator_(step_, start_,
                 {.members = settings.members,
                  .wander = {settings.motor_wander_m, settings.load_wander_m},
                  .seed = settings.seed,
                  .rate_friction = settings.rate_friction,
                  .interval_s = longest_interval_s}),
      sensors_(std::move(sensors)) {
    for (const ObserverSensor& sensor : sensors_) {
        if (!sensor.is_load_displacement)
            tensions_.push_back({spot_at(cable, sensor.place_m), 0.0, {.additive_N = settings.noise_N}});
    }
}

void Observer::update(double time_s, std::span<const double> readings) {
    KnownEnds ends{start_.displacement_m.front() - readings[0], load_m_};
    std::size_t tension = 0;
    for (std::size_t k = 0; k < sensors_.size(); ++k) {
        if (sensors_[k].is_load_displacement)
            ends.distal_displacement_m = readings[k + 1];
        else
            tensions_[tension++].value_N = readings[k + 1];
    }
    estimator_.set_interval(std::clamp(time_s - time_s_, shortest_interval_s, longest_interval_s));
    report_ = estimator_.step(ends, tensions_);
    load_m_ = ends.distal_displacement_m;
    time_s_ = time_s;
}

void Observer::write_estimate(std::span<double> mean_N, std::span<double> low_N,
                              std::span<double> high_N) const {
    for (std::size_t node = 0; node < mean_N.size(); ++node) {
        const double half_N = deviations_of_95 * estimator_.deviation_N()[node];
        mean_N[node] = estimator_.mean_N()[node];
        low_N[node] = mean_N[node] - half_N;
        high_N[node] = mean_N[node] + half_N;
    }
}

}  // namespace capstan
