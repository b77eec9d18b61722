#include "capstan/recording/nominal_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/cable_cut.h"
#include "capstan/platform/statistics.h"

namespace capstan {

namespace {

constexpr double length_tolerance_m = 1e-6;

// R_profile as the lengths of its pieces; a piece without an R is straight.
std::vector<CurvaturePiece> curvature_of(const JsonObject& nominal, Assumptions& assumptions) {
    const double length_m = nominal.positive("L");
    if (!nominal.has("R_profile")) {
        assumptions.add("nominal.R_profile", "the cable is taken as straight");
        return {{length_m, straight}};
    }
    std::vector<CurvaturePiece> pieces;
    double reached_m = 0.0;
    for (const JsonObject& piece : nominal.objects("R_profile")) {
        const double from_m = piece.number("s0");
        const double to_m = piece.number("s1");
        if (std::abs(from_m - reached_m) > length_tolerance_m)
            piece.add_problem("s0",
                              fmt::format("is {} m, but the pieces before end at {} m; state every piece, a "
                                          "straight one without R",
                                          from_m, reached_m));
        if (to_m <= from_m) piece.add_problem("s1", "must lie beyond s0");
        pieces.push_back({to_m - from_m, piece.has("R") ? piece.positive("R") : straight});
        reached_m = to_m;
    }
    if (std::abs(reached_m - length_m) > length_tolerance_m)
        nominal.add_problem("R_profile", fmt::format("ends at {} m, but L is {} m", reached_m, length_m));
    return pieces;
}

// A range holds the number with a probability of 95%.
StatedNumber within(std::pair<double, double> range) {
    return {std::sqrt(range.first * range.second),
            std::log(range.second / range.first) / (2.0 * two_sided_95)};
}

// What cables in sheaths have, from tendons of polymer fibre to steel ropes of 3 mm.
constexpr std::pair usual_friction{0.03, 0.5};
constexpr std::pair usual_axial_stiffness_N{500.0, 5e5};
constexpr std::pair usual_pretension_N{0.3, 300.0};

std::string sought(std::pair<double, double> range, const char* what, const char* unit) {
    return fmt::format("{0} is taken as {1:.5g}{4}; a diagnosis seeks it from {2} to {3}{4}", what,
                       within(range).value, range.first, range.second, unit);
}

// EA in N, or K in N/m of the complete cable.
StatedNumber axial_stiffness_N(const JsonObject& nominal, Assumptions& assumptions) {
    if (nominal.has("EA") && nominal.has("K"))
        nominal.add_problem("K", "and EA are both stated; state one: K end to end (N/m), or EA (N)");
    if (nominal.has("EA")) return value_or_range(nominal, "EA");
    if (nominal.has("K")) {
        StatedNumber stiffness = value_or_range(nominal, "K");
        stiffness.value *= nominal.positive("L");
        return stiffness;
    }
    assumptions.add("nominal.K or nominal.EA", sought(usual_axial_stiffness_N, "EA", " N"));
    return within(usual_axial_stiffness_N);
}

StatedNumber dynamic_friction(const JsonObject& nominal, Assumptions& assumptions) {
    if (!nominal.has("mu_d")) {
        assumptions.add("nominal.mu_d", sought(usual_friction, "it", ""));
        return within(usual_friction);
    }
    const auto range = nominal.optional_range("mu_d");
    const StatedNumber stated = range ? within(*range) : StatedNumber{nominal.number("mu_d")};
    const double friction = stated.value;
    if (friction < 0.0) nominal.add_problem("mu_d", "must not be negative");
    constexpr double largest_friction = 5.0;
    if (friction > largest_friction)
        nominal.add_problem("mu_d",
                            fmt::format("is {:.4g}, but no cable in a sheath has more than {}; dynamic "
                                        "friction is usually 0.03 to 0.5",
                                        friction, largest_friction));
    return stated;
}

}  // namespace

void check_size(const JsonObject& object, const char* key, double value, std::pair<double, double> built,
                const char* unit, const char* is) {
    if (value <= 0.0 || (value >= built.first && value <= built.second)) return;
    object.add_problem(
        key, fmt::format("{} {:.4g} {}, but what is built has {:.4g} to {:.4g} {}; is it in another unit?",
                         is, value, unit, built.first, built.second, unit));
}

StatedNumber value_or_range(const JsonObject& object, const char* key) {
    if (const auto range = object.optional_range(key)) return within(*range);
    return {object.positive(key)};
}

NominalBench nominal_of(const JsonObject& nominal, Assumptions& assumptions) {
    NominalBench bench;
    bench.curvature = curvature_of(nominal, assumptions);
    bench.motor_radius_m = nominal.positive("r_input");
    bench.load_radius_m = nominal.positive("r_load");
    const StatedNumber stiffness_N = axial_stiffness_N(nominal, assumptions);
    check_size(nominal, "L", length_m(bench.curvature), {1e-3, 1e3}, "m");
    check_size(nominal, "r_input", bench.motor_radius_m, {1e-4, 10.0}, "m");
    check_size(nominal, "r_load", bench.load_radius_m, {1e-4, 10.0}, "m");
    constexpr std::pair built_axial_stiffness_N{1e-2, 1e9};
    if (nominal.has("EA")) check_size(nominal, "EA", stiffness_N.value, built_axial_stiffness_N, "N");
    if (nominal.has("K"))
        check_size(nominal, "K", stiffness_N.value, built_axial_stiffness_N, "N", "times L is");
    bench.axial_stiffness_N = stiffness_N.value;
    bench.spread.stiffness = stiffness_N.spread;
    const StatedNumber friction = dynamic_friction(nominal, assumptions);
    bench.dynamic_friction = friction.value;
    bench.spread.friction = friction.spread;
    bench.static_friction = bench.dynamic_friction;
    if (nominal.has("mu_s")) {
        bench.static_friction = nominal.number("mu_s");
    } else {
        assumptions.add("nominal.mu_s", fmt::format("taken as mu_d, {:.4g}", bench.dynamic_friction));
    }
    bench.rotor_inertia_kg_m2 = nominal.optional_number("rotor_inertia").value_or(0.0);
    bench.load_pulley_inertia_kg_m2 = nominal.optional_number("load_pulley_inertia").value_or(0.0);
    // The middle of a range may lie above it.
    if (friction.spread > 0.0) bench.static_friction = std::max(bench.static_friction, friction.value);
    if (bench.static_friction < bench.dynamic_friction)
        nominal.add_problem("mu_s",
                            "is below mu_d; static friction holds at least as much as dynamic friction");
    return bench;
}

void complete_pretensions(const JsonObject& sidecar, Recording& recording, Assumptions& assumptions) {
    const auto is_missing = [](const RecordedRun& run) { return !run.pretension_N; };
    if (std::none_of(recording.runs.begin(), recording.runs.end(), is_missing)) return;
    if (!std::all_of(recording.runs.begin(), recording.runs.end(), is_missing)) {
        for (std::size_t run = 0; run < recording.runs.size(); ++run)
            if (is_missing(recording.runs[run]))
                sidecar.add_problem(fmt::format("runs[{}].T0", run),
                                    "is missing, but other runs state it; the pretension of a cable when the "
                                    "run began, in N, or a range [low, high]");
        return;
    }
    const StatedNumber pretension_N = within(usual_pretension_N);
    assumptions.add("T0 of every run", sought(usual_pretension_N, "each", " N"));
    recording.nominal->spread.pretension = pretension_N.spread;
    for (RecordedRun& run : recording.runs) run.pretension_N = pretension_N.value;
}

}  // namespace capstan
