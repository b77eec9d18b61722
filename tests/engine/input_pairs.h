#pragma once

#include <string>
#include <vector>

#include "capstan/cable/cable_state.h"
#include "capstan/solver/end_condition.h"

namespace capstan::test {

/// What is known of an end.
enum class EndKind { position, tension, spring };

struct InputPair {
    EndKind proximal;
    EndKind distal;
};

/// All that determine the cable: every two but a tension at both ends.
inline std::vector<InputPair> every_input_pair() {
    std::vector<InputPair> pairs;
    for (const EndKind proximal : {EndKind::position, EndKind::tension, EndKind::spring}) {
        for (const EndKind distal : {EndKind::position, EndKind::tension, EndKind::spring}) {
            if (proximal != EndKind::tension || distal != EndKind::tension)
                pairs.push_back({proximal, distal});
        }
    }
    return pairs;
}

/// An end whose tension is prescribed follows the other one, so the cable hangs between them only where it is
/// 0.
inline bool prescribes_a_tension(const InputPair& pair) {
    return pair.proximal == EndKind::tension || pair.distal == EndKind::tension;
}

inline std::string name_of(EndKind kind) {
    switch (kind) {
        case EndKind::position:
            return "Position";
        case EndKind::tension:
            return "Tension";
        case EndKind::spring:
            return "Spring";
    }
    return {};
}

inline std::string name_of(const InputPair& pair) {
    return name_of(pair.proximal) + name_of(pair.distal);
}

/// What an end is asked for. A position is put at the displacement, a tension is set; a spring has that
/// tension when the end is at that displacement.
struct EndTarget {
    double tension_N = 0.0;
    double displacement_m = 0.0;
};

inline EndTarget proximal_end(const CableState& state) {
    return {state.tension_N.front(), state.displacement_m.front()};
}
inline EndTarget distal_end(const CableState& state) {
    return {state.tension_N.back(), state.displacement_m.back()};
}

inline EndConditions ends_of(const InputPair& pair, const EndTarget& proximal, const EndTarget& distal,
                             double spring_N_per_m) {
    const auto condition = [&](EndKind kind, const EndTarget& target, auto spring) {
        switch (kind) {
            case EndKind::position:
                return EndCondition::position_m(target.displacement_m);
            case EndKind::tension:
                return EndCondition::tension_N(target.tension_N);
            case EndKind::spring:
                return spring(WallSpring{spring_N_per_m, target.tension_N, target.displacement_m});
        }
        return EndCondition{};
    };
    return {condition(pair.proximal, proximal, proximal_spring),
            condition(pair.distal, distal, distal_spring)};
}

}  // namespace capstan::test
