#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capstan/import/finding.h"
#include "capstan/import/mapping.h"
#include "capstan/recording/recording.h"

namespace capstan::imports {

/// How far a guess can be relied on.
enum class Doubt { stated, likely, doubtful };

/// One thing that a suggestion had to guess, and why it guessed so.
struct Guess {
    std::string about;  ///< a channel, "time", "recording", "file"
    Doubt doubt = Doubt::likely;
    std::string reason;
};

/// A mapping proposed for logs, for a person to correct.
struct Suggestion {
    Mapping mapping;
    std::vector<Guess> guesses;
    std::vector<Finding> findings;  ///< of a trial import with it

    /// The mapping with each guess and its doubt as a comment.
    std::string text() const;
};

struct SuggestOptions {
    std::optional<BenchMode> mode{};  ///< of the recording; nothing: guessed
    logs::TextFormat text{};
    std::function<void(const std::string& activity, double fraction)> on_progress{};
};

/// Proposes a mapping: which columns are the channels by their names and by how they move together; units by
/// what the file states, by the lattice of an encoder and by the balance of work; signs by the direction in
/// which motor and load pull, and because friction takes work; clocks by correlation. Throws InvalidInput
/// where no column can be a channel.
Suggestion suggest_mapping(const std::vector<std::filesystem::path>& files,
                           const SuggestOptions& options = {});

}  // namespace capstan::imports
