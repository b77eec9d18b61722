#include "capstan/storage/integrity/content_hash.h"

#include <map>

#include "capstan/storage/integrity/hashed_rows.h"
#include "capstan/storage/integrity/world_hash.h"

namespace capstan::storage {
namespace {

void keep_hash(Database& database, std::int64_t study_id, const std::string& part, int part_index,
               const std::string& table, const std::string& sha256) {
    Statement insert(database,
                     "INSERT OR REPLACE INTO content_hash (study_id, part, part_index, table_name, sha256) "
                     "VALUES (?, ?, ?, ?, ?)");
    insert.bind_all(study_id, std::string_view(part), part_index, std::string_view(table),
                    std::string_view(sha256));
    insert.run("write a hash");
}

void hash_rows(Database& database, const StudyIds& ids, const std::string& part, int part_index,
               const std::vector<HashedRows>& tables) {
    for (const auto& [table, sha256] : digests_of(database, ids, tables))
        keep_hash(database, ids.study_id, part, part_index, table, sha256);
}

}  // namespace

bool is_hashed(Database& database, std::int64_t study_id) {
    Statement select(database, "SELECT 1 FROM content_hash WHERE study_id = ?1 AND part = 'description'");
    select.bind(1, study_id);
    return select.step();
}

void hash_description(Database& database, const StudyIds& ids) {
    hash_rows(database, ids, "description", 0, description_rows(ids));
    hash_rows(database, ids, "description", 0, {candidate_rows(ids.study_id)});
}

void hash_candidates(Database& database, std::int64_t study_id) {
    if (!is_hashed(database, study_id)) return;
    hash_rows(database, {study_id, {}, {}, {}, {}}, "description", 0, {candidate_rows(study_id)});
}

void hash_unit(Database& database, const StudyIds& ids, int unit_index) {
    if (!is_hashed(database, ids.study_id)) return;
    hash_rows(database, ids, "unit", unit_index, unit_rows(database, ids, unit_index));
}

void hash_unit(Database& database, const StudyIds& ids, int unit_index,
               std::initializer_list<WrittenRows*> tables) {
    for (WrittenRows* const rows : tables)
        if (rows != nullptr && rows->has_rows())
            keep_hash(database, ids.study_id, "unit", unit_index, rows->table(), rows->finish());
}

void hash_world_errors(Database& database, std::int64_t study_id, std::span<const WorldErrorRecord> errors) {
    if (!is_hashed(database, study_id)) return;
    const HashedColumns columns = hashed_columns("world_error", {});
    Statement stored(database, "SELECT " + columns.selected() +
                                   " FROM world_error WHERE study_id = ? AND condition = ? AND "
                                   "candidate_index = ? AND world = ?");
    Statement before(database,
                     "SELECT sha256 FROM content_hash WHERE study_id = ? AND part = ? AND part_index = ?");
    std::map<std::pair<std::string, int>, std::string> sums;
    RowDigest digest;
    for (const WorldErrorRecord& error : errors) {
        const std::pair part{world_part(error.condition), error.world / worlds_per_block};
        const auto [sum, is_new] = sums.try_emplace(part);
        if (is_new) {
            before.bind_all(study_id, std::string_view(part.first), part.second);
            if (before.step()) sum->second = before.get<std::string>(0);
            before.reset();
        }
        stored.bind_all(study_id, std::string_view(error.condition), error.candidate_index, error.world);
        while (stored.step("hash an error in a world")) digest.add_row(stored, columns.names);
        stored.reset();
        sum->second = sum_of(sum->second, digest.finish());
    }
    for (const auto& [part, sum] : sums)
        keep_hash(database, study_id, part.first, part.second, "world_error", sum);
}

void hash_conclusions(Database& database, const StudyIds& ids) {
    if (!is_hashed(database, ids.study_id)) return;
    hash_rows(database, ids, "conclusions", 0, conclusion_rows(ids.study_id));
    hash_rows(database, ids, "study", 0, {hash_list_rows(ids.study_id)});
}

void hash_diagnosis(Database& database, std::int64_t diagnosis_id) {
    Statement insert(database,
                     "INSERT INTO diagnosis_hash (diagnosis_id, table_name, sha256) VALUES (?, ?, ?)");
    for (const auto& [table, sha256] : digests_of(database, {}, diagnosis_rows(diagnosis_id))) {
        insert.bind_all(diagnosis_id, std::string_view(table), std::string_view(sha256));
        insert.run("write a hash");
    }
}

std::string study_hash(Database& database, std::int64_t study_id) {
    Statement select(database, "SELECT sha256 FROM content_hash WHERE study_id = ?1 AND part = 'study'");
    select.bind(1, study_id);
    return select.step() ? select.get<std::string>(0) : "";
}

}  // namespace capstan::storage
