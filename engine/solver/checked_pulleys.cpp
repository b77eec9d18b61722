#include "capstan/solver/checked_pulleys.h"

#include <cmath>
#include <string>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan {

Pulleys checked(const Pulleys& pulleys) {
    std::vector<std::string> problems;
    const auto check = [&](double radius_m, const std::string& name) {
        if (!(radius_m > 0.0) || !std::isfinite(radius_m)) {
            problems.push_back("the " + name +
                               " pulley's radius is not a positive length; give it in metres");
        }
    };
    check(pulleys.motor_radius_m, "motor");
    check(pulleys.load_radius_m, "load");
    if (!problems.empty()) throw InvalidInput(problems);
    return pulleys;
}

}  // namespace capstan
