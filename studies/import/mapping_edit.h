#pragma once

#include <optional>
#include <string>

#include "capstan/import/mapping.h"

namespace capstan::imports {

/// One change of a mapping: what is not stated stays as it is.
struct MappingEdit {
    std::string channel;  ///< "motor_angle", or "time"
    bool remove = false;
    /// Another column: what was known of the old one (sign, zero, clock, steps) and its comments go.
    std::optional<ColumnPlace> from;
    /// Another unit: scale, counts_per_turn and torque_constant go unless they are stated too.
    std::optional<std::string> unit;
    std::optional<double> sign;  ///< 1 or -1
    std::optional<double> zero;  ///< in the column's unit
    std::optional<double> scale;
    std::optional<double> counts_per_turn;
    std::optional<double> torque_constant;  ///< N m per A
};

/// The text of a mapping with the change made. Its comments stay with the key that they stand at, except for
/// the guesses of a suggestion that the change answers. A mapping without channels may be edited. Throws
/// InvalidInput where the text is not a mapping.
std::string edited_mapping(const std::string& toml, const std::string& file, const MappingEdit& edit);

}  // namespace capstan::imports
