#pragma once

#include <string>

#include "capstan/cable/cable.h"
#include "capstan/solver/model_rules.h"
#include "choices.h"
#include "input_pairs.h"

namespace capstan::fuzz {

/// Something handed to the engine, and the words by which it must be refused; empty: it must be taken.
template <typename Input>
struct Trial {
    Input input;
    std::string refused_by{};
};

/// Lengths of millimetres to metres, straight or bent down to a millimetre, mu_d 0 to 2, 1 to 60 segments;
/// now and then with a number that cannot be.
Trial<CableSpecification> any_cable(Choices& choices);

ModelRules any_rules(Choices& choices);

test::InputPair any_pair(Choices& choices);

/// Both ends from where the cable is: at rest, on by anything from a nanometre to slack or a thousand times
/// the tension, anywhere; now and then with a number that cannot be, or a tension at both ends.
Trial<EndConditions> any_ends(Choices& choices, const test::InputPair& pair, const CableState& state,
                              const Cable& cable);

/// A value that no input may have.
double no_number(Choices& choices);

}  // namespace capstan::fuzz
