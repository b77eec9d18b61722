#include "capstan/cable/conduit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "capstan/cable/cable_cut.h"

namespace capstan {

namespace {

std::string metres(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g m", value);
    return text;
}

bool is_positive(double value) {
    return std::isfinite(value) && value > 0.0;
}

}  // namespace

std::vector<KeyProblem> problems_of(const std::vector<Bend>& bends, double length_m) {
    std::vector<KeyProblem> problems;
    if (!is_positive(length_m))
        problems.push_back({"length_m", "is " + metres(length_m) + ", but must be above 0"});
    std::vector<std::size_t> order(bends.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return bends[a].at_m < bends[b].at_m; });
    double free_m = 0.0;
    for (const std::size_t k : order) {
        const Bend& bend = bends[k];
        const std::string key = "bend[" + std::to_string(k + 1) + "]";
        if (!is_positive(bend.angle_rad) || !is_positive(bend.radius_m)) {
            problems.push_back({key, "its angle and its radius must be above 0"});
        } else if (!(bend.at_m >= free_m - same_place_m)) {
            problems.push_back({key + ".at_m", "is " + metres(bend.at_m) +
                                                   ", but the conduit is free only from " + metres(free_m) +
                                                   " on, where the bend before it ends"});
        } else if (!(bend.end_m() <= length_m + same_place_m)) {
            problems.push_back({key + ".at_m", "the bend ends at " + metres(bend.end_m()) +
                                                   ", beyond the conduit of " + metres(length_m) +
                                                   "; at_m is where it begins"});
        } else {
            free_m = bend.end_m();
        }
    }
    return problems;
}

std::vector<CurvaturePiece> pieces_of(std::vector<Bend> bends, double length_m) {
    if (const auto problems = problems_of(bends, length_m); !problems.empty()) throw InvalidInput(problems);
    std::stable_sort(bends.begin(), bends.end(),
                     [](const Bend& a, const Bend& b) { return a.at_m < b.at_m; });
    std::vector<CurvaturePiece> pieces;
    double end_m = 0.0;
    const auto add_straight_to = [&](double place_m) {
        if (place_m - end_m > same_place_m) pieces.push_back({place_m - end_m, straight});
    };
    for (const Bend& bend : bends) {
        add_straight_to(bend.at_m);
        pieces.push_back({bend.angle_rad * bend.radius_m, bend.radius_m});
        end_m = bend.end_m();
    }
    add_straight_to(length_m);
    return pieces;
}

}  // namespace capstan
