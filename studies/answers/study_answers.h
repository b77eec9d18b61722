#pragma once
// What is known of a study: its description, its cost, one repetition of it; and the catalogues it chooses
// from.

#include <cstdint>
#include <string>
#include <vector>

#include "capstan/placement/replay.h"
#include "capstan/placement/study_cost.h"
#include "capstan/reports/answer.h"
#include "capstan/storage/database.h"
#include "capstan/storage/read_only_query.h"
#include "capstan/storage/records.h"
#include "capstan/storage/study_store.h"

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

/// The rows as columns side by side, numbers to the right in six digits.
std::string rows_text(const storage::QueryResult& result);
/// The rows as a JSON array of objects, one object after the other.
std::string rows_json(const storage::QueryResult& result);
/// One of those objects, indented as it stands in the array.
std::string row_json(const std::vector<std::string>& columns, const std::vector<storage::QueryValue>& row);

}  // namespace capstan::answers
