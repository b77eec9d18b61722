#include "capstan/import/units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>

namespace capstan::imports {

namespace {

constexpr double gravity_m_s2 = 9.80665;
constexpr double pound_kg = 0.45359237;
constexpr double ounce_kg = pound_kg / 16.0;
constexpr double inch_m = 0.0254;
constexpr double degree_rad = std::numbers::pi / 180.0;

struct NamedUnit {
    Unit unit;
    std::string_view spellings;  ///< further ones, in lower case without blanks and signs, between commas
};

// A name comes first where two units share a spelling.
constexpr std::array units = {
    NamedUnit{{"s", Quantity::time, 1.0}, "sec,secs,second,seconds"},
    NamedUnit{{"ms", Quantity::time, 1e-3}, "msec,millisecond,milliseconds,millis"},
    NamedUnit{{"us", Quantity::time, 1e-6}, "usec,µs,microsecond,microseconds,micros"},
    NamedUnit{{"ns", Quantity::time, 1e-9}, "nsec,nanosecond,nanoseconds,nanos"},
    NamedUnit{{"min", Quantity::time, 60.0}, "minute,minutes"},
    NamedUnit{{"rad", Quantity::angle, 1.0}, "radian,radians,rads"},
    NamedUnit{{"mrad", Quantity::angle, 1e-3}, "milliradian,milliradians"},
    NamedUnit{{"deg", Quantity::angle, degree_rad}, "degree,degrees,degs,°"},
    NamedUnit{{"turn", Quantity::angle, 2.0 * std::numbers::pi}, "turns,rev,revs,revolution,revolutions"},
    NamedUnit{{"N m", Quantity::torque, 1.0}, "nm,newtonmeter,newtonmeters,newtonmetre,newtonmetres"},
    NamedUnit{{"mN m", Quantity::torque, 1e-3}, "mnm,nmm,millinewtonmeter,millinewtonmeters"},
    NamedUnit{{"N cm", Quantity::torque, 1e-2}, "ncm"},
    NamedUnit{{"kgf cm", Quantity::torque, gravity_m_s2 * 1e-2}, "kgfcm,kgcm"},
    NamedUnit{{"ozf in", Quantity::torque, ounce_kg* gravity_m_s2* inch_m}, "ozfin,ozin,inoz"},
    NamedUnit{{"lbf in", Quantity::torque, pound_kg* gravity_m_s2* inch_m}, "lbfin,lbin,inlb,inlbf,inlbs"},
    NamedUnit{{"lbf ft", Quantity::torque, pound_kg* gravity_m_s2* inch_m * 12.0}, "lbfft,lbft,ftlb,ftlbf"},
    NamedUnit{{"N", Quantity::force, 1.0}, "newton,newtons"},
    NamedUnit{{"mN", Quantity::force, 1e-3}, "millinewton,millinewtons"},
    NamedUnit{{"kN", Quantity::force, 1e3}, "kilonewton,kilonewtons"},
    NamedUnit{{"g", Quantity::force, gravity_m_s2 * 1e-3}, "gf,gram,grams,gramf"},
    NamedUnit{{"kg", Quantity::force, gravity_m_s2}, "kgf,kilogram,kilograms,kp"},
    NamedUnit{{"lbf", Quantity::force, pound_kg* gravity_m_s2}, "lb,lbs,pound,pounds"},
    NamedUnit{{"ozf", Quantity::force, ounce_kg* gravity_m_s2}, "oz,ounce,ounces"},
    NamedUnit{{"m", Quantity::length, 1.0}, "meter,meters,metre,metres"},
    NamedUnit{{"cm", Quantity::length, 1e-2}, "centimeter,centimeters"},
    NamedUnit{{"mm", Quantity::length, 1e-3}, "millimeter,millimeters,millimetre,millimetres"},
    NamedUnit{{"um", Quantity::length, 1e-6}, "µm,micron,microns,micrometer"},
    NamedUnit{{"in", Quantity::length, inch_m}, "inch,inches"},
    NamedUnit{{"m/s", Quantity::speed, 1.0}, "mps,ms^-1"},
    NamedUnit{{"mm/s", Quantity::speed, 1e-3}, "mmps"},
    NamedUnit{{"rad/s", Quantity::angular_speed, 1.0}, "radps"},
    NamedUnit{{"deg/s", Quantity::angular_speed, degree_rad}, "dps,°/s,degps"},
    NamedUnit{{"rpm", Quantity::angular_speed, 2.0 * std::numbers::pi / 60.0}, "rev/min,1/min"},
    NamedUnit{{"A", Quantity::current, 1.0}, "amp,amps,ampere,amperes"},
    NamedUnit{{"mA", Quantity::current, 1e-3}, "milliamp,milliamps,milliampere,milliamperes"},
    NamedUnit{{"counts", Quantity::counts, 1.0}, "count,cnt,cnts,ticks,tick,lsb,steps,pulses,qc,inc"},
    NamedUnit{{"V", Quantity::plain, 1.0}, "volt,volts"},
    NamedUnit{{"mV", Quantity::plain, 1e-3}, "millivolt,millivolts"},
    NamedUnit{{"1", Quantity::plain, 1.0}, "none,-,ratio"},
};

std::string without_signs(std::string_view text, bool lower) {
    std::string plain;
    for (const char c : text) {
        if (c == ' ' || c == '*' || c == '.' || c == '?' || c == '_') continue;
        plain += lower ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : c;
    }
    for (const std::string_view dot : {"·", "⋅"}) {
        for (std::size_t at = plain.find(dot); at != std::string::npos; at = plain.find(dot))
            plain.erase(at, dot.size());
    }
    return plain;
}

bool lists(std::string_view spellings, std::string_view word) {
    while (!spellings.empty()) {
        const std::size_t comma = spellings.find(',');
        if (spellings.substr(0, comma) == word) return true;
        spellings.remove_prefix(comma == std::string_view::npos ? spellings.size() : comma + 1);
    }
    return false;
}

}  // namespace

std::optional<Unit> find_unit(std::string_view text) {
    const std::string exact = without_signs(text, false);
    if (exact.empty()) return std::nullopt;
    for (const NamedUnit& known : units) {
        if (without_signs(known.unit.name, false) == exact) return known.unit;
    }
    const std::string lower = without_signs(text, true);
    for (const NamedUnit& known : units) {
        if (lists(known.spellings, lower)) return known.unit;
    }
    // "NM", "DEG", "MS": capitals as some programs write them. One letter alone could be another unit.
    for (const NamedUnit& known : units) {
        if (lower.size() > 1 && without_signs(known.unit.name, true) == lower) return known.unit;
    }
    return std::nullopt;
}

std::string_view si_unit(Quantity quantity) {
    switch (quantity) {
        case Quantity::time:
            return "s";
        case Quantity::angle:
            return "rad";
        case Quantity::torque:
            return "N m";
        case Quantity::force:
            return "N";
        case Quantity::length:
            return "m";
        case Quantity::speed:
            return "m/s";
        case Quantity::angular_speed:
            return "rad/s";
        case Quantity::current:
            return "A";
        case Quantity::counts:
        case Quantity::plain:
            break;
    }
    return "";
}

std::string_view quantity_words(Quantity quantity) {
    switch (quantity) {
        case Quantity::time:
            return "a time";
        case Quantity::angle:
            return "an angle";
        case Quantity::torque:
            return "a torque";
        case Quantity::force:
            return "a force";
        case Quantity::length:
            return "a length";
        case Quantity::speed:
            return "a speed";
        case Quantity::angular_speed:
            return "an angular speed";
        case Quantity::current:
            return "a current";
        case Quantity::counts:
            return "counts of a converter";
        case Quantity::plain:
            break;
    }
    return "a number";
}

std::string known_units() {
    std::string words;
    for (const NamedUnit& known : units) words += (words.empty() ? "" : ", ") + std::string(known.unit.name);
    return words;
}

}  // namespace capstan::imports
