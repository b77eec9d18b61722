#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capstan/gap/diagnosis.h"

namespace capstan::gap_trial {

/// RMS of measured minus model in one channel, over all samples that are predicted.
struct ChannelRms {
    std::string channel;
    double before = 0.0;
    double after = 0.0;
    std::optional<double> held_out{};  ///< in place of `after`, each run with numbers fitted to the others
};

/// One effect of an answer.
struct AnsweredEffect {
    std::string effect;
    double probability = 0.0;  ///< its part of one hypothesis after another; sums to 1 over the effects
    std::optional<double> present{};  ///< the probability that it is there at all
    std::string varies{};             ///< the run condition that its number follows; empty: none

    double presence() const { return present.value_or(probability); }
};

/// The part of a diagnosis that is scored.
struct CaseAnswer {
    std::string name;
    std::vector<AnsweredEffect> ranked;  ///< best first
    std::vector<std::string> named;      ///< effects that the verdict names: none, one, or two together
    std::string component;
    std::string end;
    std::optional<double> position_m;
    std::vector<ChannelRms> channels;
};

CaseAnswer answer_of(const std::string& name, const gap::Diagnosis& diagnosis);

/// Writes an answer with the hash of the labels that were sealed before it was given.
void write_answer(const std::filesystem::path& path, const CaseAnswer& answer, const std::string& seal);
/// Throws InvalidInput if the file is not an answer, or belongs to another seal.
CaseAnswer read_answer(const std::filesystem::path& path, const std::string& seal);

}  // namespace capstan::gap_trial
