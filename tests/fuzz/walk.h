#pragma once

#include <array>
#include <iosfwd>
#include <map>
#include <stdexcept>
#include <string>

#include "choices.h"

namespace capstan::fuzz {

/// The engine broke a promise.
struct BrokenPromise : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Of all steps of all walks.
struct Tally {
    long steps = 0;
    long pull_pull_steps = 0;
    std::array<long, 5> of_kind{};             // MotionKind; single cables
    std::map<std::string, long> unverified{};  // by rules and stiction
    std::map<std::string, long> taken{};       // steps of the same
    std::map<std::string, long> refused{};     // by the words of the refusal
    long unmet_torques = 0;                    // pull-pull searches that ended at a jump or out of reach
};

/// One bench, cable or pull-pull pair, and as many steps as the bytes decide. Throws BrokenPromise. With
/// `trace` every input is written there before it is tried.
void walk(Choices choices, Tally& tally, std::ostream* trace);

std::ostream& operator<<(std::ostream& out, const Tally& tally);

}  // namespace capstan::fuzz
