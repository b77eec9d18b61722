#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace capstan {

/// Anything that a diagnosis can name as the cause of a gap: wrong nominal numbers, effects, sensor faults.
struct KnownCause {
    std::string name;  ///< canonical; variants of an effect share it
    std::string title;
    std::string family;
    std::vector<std::string> confusable_with{};  ///< see EffectDescription
    std::string answered_as{};                   ///< see EffectDescription
};

/// Wrong nominal numbers, then the effects, then the sensor faults, each in the order of its catalogue.
const std::vector<KnownCause>& known_causes();

/// Null for a name that no catalogue has.
const KnownCause* find_cause(std::string_view name);

/// The title; the name itself where no catalogue has it ("none", "unknown").
std::string cause_title(std::string_view name);

/// The canonical name that an answer gives a cause: its own, or that of a cause outside the list ("unknown").
std::string answered_name(const std::string& name);

/// Names of the causes whose residuals look almost like this one's, whichever row states the pair.
std::vector<std::string> confusable_causes(std::string_view name);

}  // namespace capstan
