#include "capstan/cli/corrected_model.h"

#include <fmt/format.h>

#include "capstan/config/config_truth.h"

namespace capstan::cli {

namespace {

// Index of a fitted cause in the engine's effect catalogue; past the end for wrong parameters and sensor
// faults. A study has one cable, so an effect of cable B becomes one of cable A.
std::size_t catalogue_index(const gap::FittedCause& cause) {
    const std::string variant = cause.variant == "cable B" ? "cable A" : cause.variant;
    std::size_t index = 0;
    while (index < effect_catalogue().size() &&
           (effect_catalogue()[index].name != cause.effect || effect_catalogue()[index].variant != variant))
        ++index;
    return index;
}

std::vector<double> values_of(const Effect& effect, const gap::FittedCause& cause) {
    std::vector<double> values = effect.absent;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        for (const gap::FittedNumber& number : cause.numbers) {
            if (number.name == effect.parameters[k].name) values[k] = number.value;
        }
    }
    return values;
}

}  // namespace

std::string corrected_model_text(const Recording& recording, const gap::Diagnosis& diagnosis,
                                 const std::string& verdict) {
    std::vector<std::string> comments = {
        fmt::format("The model of {} as `capstan diagnose` corrects it.", recording.name), verdict,
        "For `capstan study run CONFIG --truth THIS_FILE`: ratios are relative to the values of "
        "CONFIG."};
    TrueCable truth{diagnosis.friction_ratio, diagnosis.stiffness_ratio, diagnosis.pretension_ratio,
                    absent_effects()};
    for (const gap::FittedCause& cause : diagnosis.causes) {
        const std::size_t index = catalogue_index(cause);
        if (index < effect_catalogue().size() && effect_catalogue()[index].changes_the_cable) {
            truth.effects[index] = values_of(effect_catalogue()[index], cause);
        } else if (!cause.numbers.empty()) {
            comments.push_back(fmt::format("Not included, because it does not belong to the cable: {}{}{}.",
                                           cause.effect, cause.variant.empty() ? "" : ", ", cause.variant));
        }
    }
    return config::truth_text(truth, comments);
}

}  // namespace capstan::cli
