#pragma once

#include <string>
#include <string_view>

namespace capstan::logs {

/// The name of a column and the unit that it states in brackets at its end: "Torque [N m]", "angle (deg)".
/// Round brackets are left where they hold no unit: "x(1)".
struct NameAndUnit {
    std::string name;
    std::string unit;
};
NameAndUnit name_and_unit(std::string_view head);

/// Whether a cell is the symbol of a unit, with or without brackets: "[N m]", "deg", "counts".
bool is_unit(std::string_view cell);

/// Without the brackets around it.
std::string without_brackets(std::string_view unit);

}  // namespace capstan::logs
