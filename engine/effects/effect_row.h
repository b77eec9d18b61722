#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace capstan {

/// What a catalogue row says about an effect, beside its parameters.
struct EffectDescription {
    std::string name{};     ///< canonical: several rows can share it
    std::string variant{};  ///< distinguishes rows of one name ("load end"); empty if there is only one
    std::string title{};    ///< as a reader sees it
    std::string family{};
    std::string component{};
    std::string end{};  ///< "motor", "load" or empty
    std::string equation{};
    std::string meaning{};
    /// The name that an answer gives it where its own is none of the canonical ones; empty: its own.
    std::string answered_as{};
    bool needs_pair = false;  ///< cannot be seen on a single cable, which only pulls, with its far end held
    bool is_rare = false;     ///< parts are made to be without it
    bool changes_the_cable = false;  ///< can be part of a placement study's true cable
    /// Causes with almost the same residuals (a cosine of 0.95 and more over all protocols); each pair is
    /// stated in one of the two rows.
    std::vector<std::string> confusable_with{};
    /// How far the nominal numbers may be off because of this effect (standard deviation of the logarithm).
    /// 0: as for any other effect.
    double friction_log_std = 0.0;
    double stiffness_log_std = 0.0;
};

/// What a parameter is to a fit.
enum class ParameterRole {
    size,          ///< how much of the effect there is
    shape,         ///< what the effect looks like once it is there; positive
    place,         ///< a position along the cable
    periods,       ///< a number of periods in a turn; an integer
    normal_force,  ///< the usual normal force per length; given by the bench, not fitted
};

/// One number of an effect.
struct EffectParameter {
    std::string name{};
    std::string unit{};
    double low = 0.0;  ///< limits of what is physical
    double high = std::numeric_limits<double>::infinity();
    double typical = 1.0;  ///< of a mild case on a bench a few metres long: where a fit starts
    ParameterRole role = ParameterRole::size;
    /// The effect is an oscillation whose frequency it sets: only close to its value does it explain
    /// anything.
    bool resonates = false;
    bool is_detail = false;          ///< a further size: a search begins without it
    std::optional<double> absent{};  ///< value without the effect; none: the default of the effect's struct
};

/// A row of the catalogue for an effect with its own struct of parameters.
template <class Effect>
struct EffectRow {
    EffectDescription about;
    struct Parameter {
        EffectParameter about;
        std::function<double&(Effect&)> field;
    };
    std::vector<Parameter> parameters;
    std::function<void(Effect&)> choose_variant{};
    std::function<bool(const Effect&)> is_variant{};  ///< where choose_variant decides more than parameters
};

}  // namespace capstan
