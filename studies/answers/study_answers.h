#pragma once
// What is known of a study: its description, its cost, one repetition of it; and the catalogues it chooses
// from.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "capstan/cluster/study_status.h"
#include "capstan/placement/replay.h"
#include "capstan/placement/study_cost.h"
#include "capstan/reports/answer.h"
#include "capstan/storage/database.h"
#include "capstan/storage/health.h"
#include "capstan/storage/read_only_query.h"
#include "capstan/storage/records.h"
#include "capstan/storage/study_store.h"
#include "capstan/verification/recomputation.h"

namespace capstan::answers {

/// A stored study: cable, instants, noise levels, methods, and how far it is.
reports::Answer study_answer(storage::Database& database, std::int64_t study_id);

/// What the studies of a plan cost, split into `shards`.
reports::Answer cost_answer(const std::string& name, const StudyCost& cost,
                            const std::vector<StudyPlan>& plans, int shards);

/// One repetition: what each sensor read, and what each method made of it. `repetition` from 1.
reports::Answer replay_answer(const Replay& replayed, const storage::ScenarioRecord& scenario,
                              const std::string& noise, std::int64_t repetition);

/// The effects, the other causes that a diagnosis can name, the layout families and the fusion methods.
reports::Answer catalogue_answer();

/// The studies, with progress, date, note and tags; as `capstan study list --json` and the service write
/// them.
storage::QueryResult studies_table(storage::Database& database,
                                   storage::Shelf shelf = storage::Shelf::studies);

/// How far the shards of a submitted study are.
reports::Answer submitted_study_answer(const cluster::StudyStatus& status);

/// The size of a checked configuration, all studies of its sweep together: a few lines, and for programs.
std::string plan_size_text(const std::string& file, const StudyPlan& plan,
                           const std::vector<StudyPlan>& studies);
reports::Data plan_size_data(const StudyPlan& plan, const std::vector<StudyPlan>& studies);

/// A results database as the integrity check finds it.
struct DatabaseState {
    std::string words;
    bool is_there = false;
    bool is_intact = true;
    storage::Health health;
};
DatabaseState state_of_database(const std::filesystem::path& file);

/// The program, the processor, the optional programs and the database.
reports::Answer installation_answer(const std::string& database_file, const DatabaseState& state);

/// A part of a stored study, computed again.
reports::Answer verification_answer(std::int64_t study_id, const Sample& sample, const Recomputation& found);

}  // namespace capstan::answers
