#include "capstan/controller/capstan_observer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string>

#include "capstan/cable/conduit.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/controller/observer.h"

struct capstan_observer {
    capstan::Observer observer;
    std::size_t readings;
    std::size_t nodes;
    std::vector<double> estimate_N;  // 3 x nodes: for what the caller does not want
};

namespace {

// Beyond it a step could ask for a tension that is not finite.
constexpr double largest_reading = 1e9;

capstan::Cable made(const capstan_cable& given) {
    std::vector<capstan::Bend> bends;
    for (std::size_t k = 0; k < given.bend_count; ++k)
        bends.push_back({given.bends[k].angle_rad, given.bends[k].radius_m, given.bends[k].at_m});
    return capstan::Cable({.curvature = capstan::pieces_of(std::move(bends), given.length_m),
                           .segments = given.segments,
                           .axial_stiffness_N = given.axial_stiffness_N,
                           .dynamic_friction = given.friction,
                           .static_friction = given.static_friction,
                           .pretension_N = given.pretension_N});
}

std::vector<capstan::ObserverSensor> sensors_of(const capstan_sensor* given, std::size_t count) {
    std::vector<capstan::ObserverSensor> sensors;
    for (std::size_t k = 0; k < count; ++k) {
        if (given[k].kind != CAPSTAN_TENSION && given[k].kind != CAPSTAN_LOAD_DISPLACEMENT)
            throw capstan::InvalidInput({"sensors[" + std::to_string(k) + "].kind: is " +
                                         std::to_string(static_cast<int>(given[k].kind)) +
                                         ", but must be CAPSTAN_TENSION or CAPSTAN_LOAD_DISPLACEMENT"});
        sensors.push_back({given[k].kind == CAPSTAN_LOAD_DISPLACEMENT, given[k].place_m});
    }
    return sensors;
}

capstan::ObserverSettings settings_of(const capstan_observer_settings& given) {
    return {.noise_N = given.noise_N,
            .load_wander_m = given.load_wander_m,
            .motor_wander_m = given.motor_wander_m,
            .members = given.members,
            .seed = given.seed,
            .rate_friction = {{given.drag_N_s_per_m2},
                              {given.extra_friction, given.speed_m_per_s, given.memory_s}}};
}

void tell(const std::string& words, char* message, std::size_t bytes) {
    if (message == nullptr || bytes == 0) return;
    const std::size_t kept = std::min(words.size(), bytes - 1);
    std::memcpy(message, words.data(), kept);
    message[kept] = '\0';
}

}  // namespace

capstan_observer_settings capstan_observer_defaults(void) {
    const capstan::ObserverSettings usual;
    const capstan::RateFriction& friction = usual.rate_friction;
    return {usual.noise_N,
            usual.load_wander_m,
            usual.motor_wander_m,
            usual.members,
            usual.seed,
            friction.viscous.drag_N_s_per_m2,
            friction.stribeck.extra_friction,
            friction.stribeck.speed_m_per_s,
            friction.stribeck.memory_s};
}

size_t capstan_observer_bytes(void) {
    return sizeof(capstan_observer);
}

capstan_status capstan_observer_create(void* storage, size_t storage_bytes, const capstan_cable* cable,
                                       const capstan_sensor* sensors, size_t sensor_count,
                                       const capstan_observer_settings* settings, char* message,
                                       size_t message_bytes, capstan_observer** observer) {
    tell("", message, message_bytes);
    if (storage == nullptr || cable == nullptr || settings == nullptr || observer == nullptr ||
        (sensors == nullptr && sensor_count > 0) || (cable->bends == nullptr && cable->bend_count > 0))
        return CAPSTAN_NULL_ARGUMENT;
    *observer = nullptr;
    const bool aligned = reinterpret_cast<std::uintptr_t>(storage) % alignof(capstan_observer) == 0;
    if (storage_bytes < sizeof(capstan_observer) || !aligned) return CAPSTAN_STORAGE_TOO_SMALL;
    try {
        const capstan::Cable its_cable = made(*cable);
        const auto nodes = static_cast<std::size_t>(its_cable.nodes());
        *observer = new (storage)
            capstan_observer{{its_cable, sensors_of(sensors, sensor_count), settings_of(*settings)},
                             sensor_count + 1,
                             nodes,
                             std::vector<double>(3 * nodes)};
        return CAPSTAN_OK;
    } catch (const capstan::InvalidInput& error) {
        std::string words;
        for (const std::string& problem : error.problems()) words += (words.empty() ? "" : "\n") + problem;
        tell(words, message, message_bytes);
        return CAPSTAN_WRONG_INPUT;
    } catch (const std::bad_alloc&) {
        return CAPSTAN_OUT_OF_MEMORY;
    } catch (...) {
        return CAPSTAN_INTERNAL_ERROR;
    }
}

void capstan_observer_destroy(capstan_observer* observer) {
    if (observer != nullptr) observer->~capstan_observer();
}

int capstan_observer_nodes(const capstan_observer* observer) {
    return observer == nullptr ? 0 : observer->observer.nodes();
}

capstan_status capstan_observer_update(capstan_observer* observer, double time_s, const double* readings,
                                       double* mean_N, double* low_N, double* high_N) {
    if (observer == nullptr || readings == nullptr) return CAPSTAN_NULL_ARGUMENT;
    if (!(time_s > observer->observer.time_s()) || !std::isfinite(time_s)) return CAPSTAN_TIME_NOT_RISING;
    for (std::size_t k = 0; k < observer->readings; ++k) {
        if (!(std::abs(readings[k]) < largest_reading)) return CAPSTAN_READING_NOT_FINITE;
    }
    try {
        observer->observer.update(time_s, {readings, observer->readings});
    } catch (...) {
        return CAPSTAN_INTERNAL_ERROR;
    }
    const std::size_t nodes = observer->nodes;
    double* unwanted_N = observer->estimate_N.data();
    observer->observer.write_estimate({mean_N != nullptr ? mean_N : unwanted_N, nodes},
                                      {low_N != nullptr ? low_N : unwanted_N + nodes, nodes},
                                      {high_N != nullptr ? high_N : unwanted_N + 2 * nodes, nodes});
    return CAPSTAN_OK;
}

const char* capstan_status_words(capstan_status status) {
    switch (status) {
        case CAPSTAN_OK:
            return "done";
        case CAPSTAN_NULL_ARGUMENT:
            return "a pointer that is needed is NULL";
        case CAPSTAN_STORAGE_TOO_SMALL:
            return "the storage is smaller than capstan_observer_bytes(), or not aligned";
        case CAPSTAN_WRONG_INPUT:
            return "cable, sensors or settings are wrong; the message says how";
        case CAPSTAN_OUT_OF_MEMORY:
            return "out of memory";
        case CAPSTAN_TIME_NOT_RISING:
            return "the time is not a number above the last one";
        case CAPSTAN_READING_NOT_FINITE:
            return "a reading is not a number, or not below 1e9";
        case CAPSTAN_INTERNAL_ERROR:
            return "an error of the library; please report it";
    }
    return "no status of capstan";
}
