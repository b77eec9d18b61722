#pragma once
// Which build of the program, with which vector instructions, computed a study.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capstan/storage/database.h"

namespace capstan::storage {

struct Computation {
    std::string simd;             // "AVX2"
    std::string compiler;         // "g++ 12.2.0"
    std::string program_version;  // of capstan
    bool operator==(const Computation&) const = default;
};

/// This program on this processor.
Computation this_computation();

/// Stores it, unless the study has it already. Before the first result of a run.
void write_computation(Database& database, std::int64_t study_id,
                       const Computation& computation = this_computation());

/// More than one where a study was resumed by another build or on another processor; none: not known.
std::vector<Computation> read_computations(Database& database, std::int64_t study_id);

/// The width with which the study was computed, where it is not the one in use.
std::optional<std::string> other_simd(Database& database, std::int64_t study_id);

/// Refuses to go on with a study that was computed with vector instructions of another width than those in
/// use: its numbers would be those of no run. An Error says what to do.
void require_same_simd(Database& database, std::int64_t study_id);

/// Looks at files that are to be joined, one after the other.
class SameComputation {
  public:
    /// What is wrong with the file, if its studies were computed with something else than those of the files
    /// before, or with two things; empty: nothing.
    std::string problem_of(Database& database);

    /// Of all files; nothing if none of them says.
    const std::optional<Computation>& common() const { return common_; }

    /// The joining program computes the conclusions, so it must use the same width. Throws an Error.
    void require_same_simd_here() const;

  private:
    std::optional<Computation> common_;
    std::string first_;  // the file that says so
};

/// "SIMD AVX2, g++ 12.2.0, capstan 0.2.0"
std::string words_of(const Computation& computation);

}  // namespace capstan::storage
