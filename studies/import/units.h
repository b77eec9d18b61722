#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace capstan::imports {

/// What a column measures.
enum class Quantity { time, angle, torque, force, length, speed, angular_speed, current, counts, plain };

/// A unit as a laboratory writes it. A force is also the weight of a mass: "g" is the force of a gram.
struct Unit {
    std::string_view name;  ///< as the mapping has it: "N m", "deg"
    Quantity quantity;
    double si = 1.0;  ///< SI units in one of these
};

/// The unit behind a name or one of its usual spellings ("Nm", "N*m", "degrees", "°"); nothing if it is not
/// known. A name that can mean two things is read as a force before a mass and as metres before minutes.
std::optional<Unit> find_unit(std::string_view text);

/// The SI unit of a quantity as a recording states it: "rad", "N m"; empty for counts.
std::string_view si_unit(Quantity quantity);

/// "torque", "an angle".
std::string_view quantity_words(Quantity quantity);

/// All names of units that are known, for messages.
std::string known_units();

}  // namespace capstan::imports
