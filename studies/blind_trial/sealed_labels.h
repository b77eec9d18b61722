#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "capstan/gap_trial/trial_case.h"

namespace capstan::gap_trial {

/// The labels of a complete trial, as they are written to labels.json.
struct TrialLabels {
    TrialOptions options;
    std::string salt;  ///< random, so that the labels cannot be guessed from their hash
    std::vector<CaseLabel> cases;
};

/// 32 random hexadecimal digits from the system.
std::string random_salt();

/// SHA-256 (FIPS 180-4) as 64 hexadecimal digits.
std::string sha256(const std::string& bytes);

std::string labels_text(const TrialLabels& labels);
/// Throws InvalidInput if the text is not what `labels_text` writes.
TrialLabels read_labels(const std::string& text, const std::string& place);

/// Writes labels.json and, in the form of sha256sum, labels.sha256 into `folder`; returns the hash.
std::string seal_labels(const std::filesystem::path& folder, const TrialLabels& labels);

/// The labels, if their file still hashes to what labels.sha256 beside it says and to `expected_hash` (where
/// that is not empty). Throws InvalidInput if not, because they were changed after they were sealed.
TrialLabels unseal_labels(const std::filesystem::path& labels_file, const std::string& expected_hash = {});

}  // namespace capstan::gap_trial
