#include <fmt/format.h>

#include "capstan/answers/recording_answers.h"
#include "capstan/config/config_truth.h"

namespace capstan::answers {

namespace {

// Where a fitted cause stands in the engine's catalogue; past the end for wrong numbers and sensors. A study
// has one cable: a bend of either of two is its own.
std::size_t catalogue_index(const gap::FittedCause& cause) {
    const std::string variant = cause.variant == "cable B" ? "cable A" : cause.variant;
    std::size_t index = 0;
    while (index < effect_catalogue().size() &&
           (effect_catalogue()[index].name != cause.effect || effect_catalogue()[index].variant != variant))
        ++index;
    return index;
}

std::vector<double> fitted_values_of(const Effect& effect, const gap::FittedCause& cause) {
    std::vector<double> values = effect.absent;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        for (const gap::FittedNumber& number : cause.numbers) {
            if (number.name == effect.parameters[k].name) values[k] = number.value;
        }
    }
    return values;
}

}  // namespace

std::string corrected_model_text(const Recording& recording, const gap::Diagnosis& diagnosis) {
    std::vector<std::string> comments = {
        fmt::format("The model of {} as `capstan diagnose` corrects it.", recording.name),
        verdict_sentence(diagnosis),
        "For `capstan study run CONFIG --truth THIS_FILE`: ratios are in parts of what CONFIG says."};
    TrueCable truth{diagnosis.friction_ratio, diagnosis.stiffness_ratio, diagnosis.pretension_ratio,
                    absent_effects()};
    for (const gap::FittedCause& cause : diagnosis.causes) {
        const std::size_t index = catalogue_index(cause);
        if (index < effect_catalogue().size() && effect_catalogue()[index].changes_the_cable) {
            truth.effects[index] = fitted_values_of(effect_catalogue()[index], cause);
        } else if (!cause.numbers.empty()) {
            comments.push_back(fmt::format("Not in here, for it is not of the cable: {}{}{}.", cause.effect,
                                           cause.variant.empty() ? "" : ", ", cause.variant));
        }
    }
    return config::truth_text(truth, comments);
}

}  // namespace capstan::answers
