#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "capstan/gap/diagnosis.h"
#include "capstan/recording/recording.h"

namespace capstan::cli {

std::string verdict_sentence(const gap::Diagnosis& diagnosis);

/// Which explanations remain, and what would decide between them; empty where the recording decides.
std::string next_experiment_in_words(const gap::NonIdentifiable& non_identifiable);

std::string in_words(const Recording& recording, const gap::Diagnosis& diagnosis);

/// The form that a judge reads (case, ranked, where, RMS before and after) and everything else.
nlohmann::ordered_json in_json(const Recording& recording, const gap::Diagnosis& diagnosis);

}  // namespace capstan::cli
