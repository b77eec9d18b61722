#pragma once

namespace capstan {

/// What is known at one end of the cable, as a line in that end's displacement u and tension T (E6):
/// displacement_factor * u + tension_factor * T = value.
struct EndCondition {
    double displacement_factor = 1.0;
    double tension_factor = 0.0;
    double value = 0.0;

    static constexpr EndCondition position_m(double displacement_m) { return {1.0, 0.0, displacement_m}; }
    static constexpr EndCondition tension_N(double tension_N) { return {0.0, 1.0, tension_N}; }
};

/// A spring between an end of the cable and a wall, `tension_N` in it when the end is at `displacement_m`.
struct WallSpring {
    double stiffness_N_per_m = 0.0;
    double tension_N = 0.0;
    double displacement_m = 0.0;
};

/// Pulling the proximal end towards the distal one stretches its spring: T = T_ref + k (u - u_ref).
constexpr EndCondition proximal_spring(const WallSpring& spring) {
    return {-spring.stiffness_N_per_m, 1.0,
            spring.tension_N - spring.stiffness_N_per_m * spring.displacement_m};
}

/// Pulling the distal end towards the proximal one stretches its spring: T = T_ref - k (u - u_ref).
constexpr EndCondition distal_spring(const WallSpring& spring) {
    return {spring.stiffness_N_per_m, 1.0,
            spring.tension_N + spring.stiffness_N_per_m * spring.displacement_m};
}

struct EndConditions {
    EndCondition proximal;
    EndCondition distal;
};

}  // namespace capstan
