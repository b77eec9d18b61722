#include "capstan/residual_law/law_words.h"

#include <fmt/format.h>

#include <cmath>

namespace capstan::residual_law {

namespace {

// The unit in which a value reads well, and its factor.
struct ReadableUnit {
    std::string name;
    double factor = 1.0;
};

ReadableUnit readable_unit(double value, const std::string& unit) {
    constexpr double small = 0.1;
    const bool has_milli = unit == "N m" || unit == "rad" || unit == "m" || unit == "A";
    if (has_milli && std::abs(value) < small) return {"m" + unit, 1000.0};
    return {unit, 1.0};
}

// With as many digits as the interval allows.
std::string with_interval(double value, double half_width, const std::string& unit) {
    const ReadableUnit readable = readable_unit(value, unit);
    const double shown = readable.factor * value;
    const double width = readable.factor * half_width;
    const double finest = width > 0.0 ? width : 0.1 * std::abs(shown);
    const int digits = finest > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(finest))), 0, 6) : 1;
    if (!(width > 0.0)) return fmt::format("{:.{}f} {}", shown, digits, readable.name);
    return fmt::format("{:.{}f} +- {:.{}f} {}", shown, digits, width, digits, readable.name);
}

std::string plain(double value, const std::string& unit) {
    const ReadableUnit readable = readable_unit(value, unit);
    const double shown = readable.factor * value;
    constexpr double large = 100.0;
    if (std::abs(shown) < large) return fmt::format("{:.2g} {}", shown, readable.name);
    const double last_digit = std::pow(10.0, std::floor(std::log10(std::abs(shown))) - 1.0);
    return fmt::format("{:.0f} {}", last_digit * std::round(shown / last_digit), readable.name);
}

// A bench that is locked does not move: its torque changes.
bool is_motion(const ResidualNames& names) {
    return names.motion_unit == "rad" || names.motion_unit == "m";
}

std::string speed_of(const ResidualNames& names) {
    return is_motion(names) ? "speed" : "rate of change of the " + names.motion;
}

std::string direction_of(const ResidualNames& names) {
    return is_motion(names) ? "direction of motion" : "direction in which the " + names.motion + " changes";
}

// The friction of the motion's history, when it has built up.
struct BuiltUpFriction {
    double unloaded = 0.0;
    double loaded = 0.0;     ///< at the largest load
    double half_path = 0.0;  ///< after a reversal, until half of the change is there
};

BuiltUpFriction built_up_friction(const ResidualLaw& law) {
    BuiltUpFriction friction;
    for (const WeightedFeature& each : law.weights) {
        if (each.feature.kind != FeatureKind::friction) continue;
        friction.loaded += each.weight;
        if (!each.feature.times_load) friction.unloaded += each.weight;
    }
    constexpr int steps = 200;
    for (int step = 1; step <= steps; ++step) {
        const double path = 2.0 * law.scales.motion_half_range * step / steps;
        double changed = 0.0;  // from -1 to 1 is 2
        for (const WeightedFeature& each : law.weights)
            if (each.feature.kind == FeatureKind::friction)
                changed += each.weight * std::min(path / each.feature.parameter, 2.0) / 2.0;
        friction.half_path = path;
        if (changed / friction.loaded >= 0.5) break;
    }
    return friction;
}

// What the history of the motion adds, as far as a few numbers say it.
std::string history_words(const ResidualLaw& law, const ResidualNames& names) {
    constexpr double worth_saying = 0.2;  // of the residual
    const BuiltUpFriction friction = built_up_friction(law);
    const double largest = std::max(std::abs(friction.unloaded), std::abs(friction.loaded));
    if (largest < worth_saying * law.residual_rms) return "it depends on the motion since the last reversals";
    std::string size = plain(friction.unloaded, names.output_unit);
    if (law.scales.load != 0.0)
        size += fmt::format(" without load and {} at a {} of {}", plain(friction.loaded, names.output_unit),
                            names.load, plain(law.scales.load, names.load_unit));
    return fmt::format(
        "it looks like {} {} that follows the {}, {}, half of which builds up within {} after a "
        "reversal, along many paths",
        names.output.starts_with('a') ? "an" : "a", names.output, direction_of(names), size,
        plain(friction.half_path, names.motion_unit));
}

}  // namespace

std::string term_words(const LawTerm& term, const FeatureScales& scales, const ResidualNames& names) {
    const Feature& first = term.features.front();
    const std::string noun = (names.output.starts_with('a') ? "an " : "a ") + names.output;
    const std::string size = with_interval(term.size, term.half_width, names.output_unit);
    const std::string range = plain(2.0 * scales.motion_half_range, names.motion_unit);
    const std::string load = first.times_load
                                 ? fmt::format(" at a {} of {}, in proportion to the {}", names.load,
                                               plain(scales.load, names.load_unit), names.load)
                                 : "";
    const std::string amount = fmt::format("{} of {}{}", noun, size, load);
    switch (first.kind) {
        case FeatureKind::constant:
            return first.times_load ? amount : fmt::format("a constant {} of {}", names.output, size);
        case FeatureKind::position: {
            const char* power = first.parameter == 1.0   ? "in proportion to"
                                : first.parameter == 2.0 ? "with the square of"
                                                         : "with the cube of";
            return fmt::format(
                "{} at the end of the range of the {} ({}), which grows {} the distance from the "
                "middle of the range",
                amount, names.motion, range, power);
        }
        case FeatureKind::wave_sine:
        case FeatureKind::wave_cosine:
            return fmt::format("{}, up and down with the {}, with a period of {}", amount, names.motion,
                               plain(first.parameter, names.motion_unit));
        case FeatureKind::speed:
        case FeatureKind::speed_magnitude:
            return fmt::format("{} at the highest {} ({}/s), in proportion to {}", amount, speed_of(names),
                               plain(scales.speed, names.motion_unit),
                               first.kind == FeatureKind::speed ? "it" : "its magnitude");
        case FeatureKind::friction:
            return fmt::format("{}, which follows the {} and has built up within {} after a reversal", amount,
                               direction_of(names), plain(2.0 * first.parameter, names.motion_unit));
        case FeatureKind::relaxation:
            return fmt::format("{}, which follows the {} and fades within about {:g} s after a reversal",
                               amount, direction_of(names), first.parameter);
        case FeatureKind::session_time:
            return fmt::format("a drift of the {} by {} within {:.0f} s of the session", names.output, size,
                               scales.session_s);
    }
    return {};
}

std::string law_sentence(const ResidualLaw& law, const ResidualNames& names) {
    if (!law.holds()) return "";
    std::string text = fmt::format("What is left in the {} is {}: ", names.channel,
                                   plain(law.residual_rms, names.output_unit));
    // A term that could as well be absent or of the other sign says nothing by itself.
    std::vector<std::string> looks_like;
    for (const LawTerm& term : law.terms)
        if (std::abs(term.size) > term.half_width) looks_like.push_back(term.words);
    const std::size_t open = law.terms.size() - looks_like.size();
    if (open > 0)
        looks_like.push_back(fmt::format("{} {}{} that the runs do not determine one by one", open,
                                         open < law.terms.size() ? "further " : "",
                                         open == 1 ? "term" : "terms"));
    if (law.terms.empty() || (open == law.terms.size() && law.has_history_model)) {
        text += history_words(law, names);
    } else {
        text += fmt::format("{} {}", open < law.terms.size() ? "it looks like" : "it depends on",
                            fmt::join(looks_like, "; and "));
        if (law.has_history_model) text += "; the rest depends on the motion since the last reversals";
    }
    text += fmt::format(". On runs that were left out this removes {:.0f}%", 100.0 * law.removed_fraction);
    if (law.removed_low)
        text += fmt::format(" ({:.0f} to {:.0f})", 100.0 * *law.removed_low, 100.0 * *law.removed_high);
    return text + fmt::format(" of its mean square; {} remain.", plain(law.left_out_rms, names.output_unit));
}

}  // namespace capstan::residual_law
