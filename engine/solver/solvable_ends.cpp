#include "capstan/solver/solvable_ends.h"

#include <string>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan {

void refuse(const EndConditions& ends) {
    std::vector<std::string> problems;
    const auto check = [&](const EndCondition& end, const char* name) {
        if (!std::isfinite(end.displacement_factor) || !std::isfinite(end.tension_factor) ||
            !std::isfinite(end.value)) {
            problems.push_back(std::string("the ") + name + " end's input is not a finite number");
        } else if (end.displacement_factor == 0.0 && end.tension_factor == 0.0) {
            problems.push_back(std::string("the ") + name + " end's input says nothing: both factors are 0");
        }
    };
    check(ends.proximal, "proximal");
    check(ends.distal, "distal");
    if (problems.empty()) {
        problems.push_back(
            "a tension is prescribed at both ends, so the displacement is undetermined; prescribe a position "
            "or a spring at one end");
    }
    throw InvalidInput(problems);
}

}  // namespace capstan
