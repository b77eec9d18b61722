#pragma once
// Which rows of which tables belong to a part of a study, and their digest.

#include <map>
#include <string>
#include <vector>

#include "capstan/storage/integrity/row_digest.h"
#include "capstan/storage/study_ids.h"

namespace capstan::storage {

/// Rows of one table: a condition in SQL, and an order in which no two of them are equal.
struct HashedRows {
    std::string table;
    std::string where;
    std::string order;
};

/// Everything that is known before the first draw, and that later steps leave as it is.
std::vector<HashedRows> description_rows(const StudyIds& ids);
HashedRows candidate_rows(std::int64_t study_id);

/// What the unit stored; its stage, scenario and noise level are looked up.
std::vector<HashedRows> unit_rows(Database& database, const StudyIds& ids, int unit_index);

/// What was worked out of the units when the study was completed.
std::vector<HashedRows> conclusion_rows(std::int64_t study_id);

/// The hashes of the study but the one over all of them.
HashedRows hash_list_rows(std::int64_t study_id);

std::vector<HashedRows> diagnosis_rows(std::int64_t diagnosis_id);

/// The columns of a table that are hashed, in the order of their names. Numbers that a file gives
/// (scenario_id, ...) are taken as positions within the study; how far a study is (status, done) is left out.
struct HashedColumns {
    std::vector<std::string> names;
    std::vector<std::string> origins;  // in SQL, what is subtracted from each; empty: nothing

    std::string selected() const;  // SQL, separated by commas
};
HashedColumns hashed_columns(const std::string& table, const StudyIds& ids);

/// Table name -> 64 hexadecimal digits; a table without a row is left out.
std::map<std::string, std::string> digests_of(Database& database, const StudyIds& ids,
                                              const std::vector<HashedRows>& tables);

}  // namespace capstan::storage
