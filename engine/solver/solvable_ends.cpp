#include "capstan/solver/solvable_ends.h"

#include <string>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan {

void refuse(const EndConditions& ends) {
    std::vector<std::string> problems;
    const auto check = [&](const EndCondition& end, const char* name, double outward) {
        const std::string input = std::string("the ") + name + " end's input ";
        const double size =
            std::abs(end.displacement_factor) + std::abs(end.tension_factor) + std::abs(end.value);
        // A quarter, so that two ends that pass here pass together.
        if (!(size <= 0.25 * largest_number)) {
            problems.push_back(input + "is not a finite number below 1e150");
        } else if (end.displacement_factor == 0.0 && end.tension_factor == 0.0) {
            problems.push_back(input + "says nothing: both factors are 0");
        } else if (!springs_back(end, outward)) {
            problems.push_back(input + "is a spring of negative stiffness, which holds nothing");
        }
    };
    check(ends.proximal, "proximal", -1.0);
    check(ends.distal, "distal", 1.0);
    if (problems.empty()) {
        problems.push_back(
            "a tension is prescribed at both ends, so the displacement is undetermined; prescribe a position "
            "or a spring at one end");
    }
    throw InvalidInput(problems);
}

}  // namespace capstan
