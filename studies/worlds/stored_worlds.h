#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "capstan/storage/database.h"
#include "capstan/storage/records.h"
#include "capstan/worlds/world_study.h"

namespace capstan {

/// Begins a study over worlds in the database; nothing of it has run. Throws InvalidInput with
/// problems_of(plan).
std::int64_t begin_worlds(storage::Database& database, const StudyPlan& plan,
                          const std::string& program_version);

/// What begin_worlds() writes. Throws InvalidInput with problems_of(plan).
storage::StudyDescription describe_worlds(const StudyPlan& plan, const std::string& program_version);

/// Runs what is missing of a study over worlds, stores every block of errors as it is there, and completes
/// the study. A killed run goes on with the same bits. What is `computed` already
/// by another run is taken where it is needed. Throws TableStopped.
WorldAnswer run_worlds(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                       const TableOptions& options, std::span<const storage::WorldErrorRecord> computed = {});

/// Computes and stores the errors of all candidates in worlds `first` to `last` - 1, every `stride`th, as far
/// as they are missing. Throws TableStopped.
void fill_worlds(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                 const TableOptions& options, int first, int last, int stride);

/// The table of a complete study; what it computes beyond that is not stored.
ErrorTable complete_table(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                          const TableOptions& options);

/// The answer without a database.
WorldAnswer run_worlds(const StudyPlan& plan, const TableOptions& options);

/// The recommendation in one sentence or two: what to buy, which error to expect, what else would help.
std::string sentence_of(const StudyPlan& plan, const WorldAnswer& answer);

}  // namespace capstan
