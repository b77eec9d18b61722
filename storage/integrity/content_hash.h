#pragma once
// The hashes of what a study stores. Every function belongs into the transaction that stores what it hashes,
// and does nothing for a study that was begun before schema version 6: such a study is not hashed.

#include <initializer_list>
#include <span>

#include "capstan/storage/integrity/written_rows.h"
#include "capstan/storage/records.h"
#include "capstan/storage/study_ids.h"

namespace capstan::storage {

/// False: the study was begun before schema version 6.
bool is_hashed(Database& database, std::int64_t study_id);

/// Marks the study as hashed.
void hash_description(Database& database, const StudyIds& ids);

/// Once more, when a search has added a set of sensors.
void hash_candidates(Database& database, std::int64_t study_id);

/// What the unit stored, read back.
void hash_unit(Database& database, const StudyIds& ids, int unit_index);
/// The same of rows that were hashed while they were written, which takes a fifth of the time.
void hash_unit(Database& database, const StudyIds& ids, int unit_index,
               std::initializer_list<WrittenRows*> tables);

/// Adds the rows to the hashes of their blocks of 64 worlds, in any order.
void hash_world_errors(Database& database, std::int64_t study_id, std::span<const WorldErrorRecord> errors);

/// The conclusions, and then the hash over all other hashes of the study.
void hash_conclusions(Database& database, const StudyIds& ids);

void hash_diagnosis(Database& database, std::int64_t diagnosis_id);

/// The hash over all hashes of a complete study; empty if it is not hashed or not complete.
std::string study_hash(Database& database, std::int64_t study_id);

}  // namespace capstan::storage
