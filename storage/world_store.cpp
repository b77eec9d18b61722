#include "capstan/storage/world_store.h"

#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/record_rows.h"
#include "capstan/storage/study_ids.h"
#include "capstan/storage/transaction.h"

namespace capstan::storage {
namespace {

template <class Record>
std::vector<Record> read_rows(Database& database, const std::string& table, const std::string& order,
                              std::int64_t study_id) {
    Statement select(database, "SELECT " + column_names<Record>() + " FROM " + table +
                                   " WHERE study_id = ?1 ORDER BY " + order);
    select.bind(1, study_id);
    std::vector<Record> rows;
    while (select.step()) rows.push_back(read_record<Record>(select));
    return rows;
}

}  // namespace

void add_world_candidate(Database& database, std::int64_t study_id, int candidate_index,
                         const WorldCandidateRecord& candidate) {
    Transaction transaction(database);
    RowWriter<WorldCandidateRecord>(database, "world_candidate", "study_id, candidate_index")
        .write(candidate, study_id, candidate_index);
    hash_candidates(database, study_id);
    transaction.commit();
}

void write_world_errors(Database& database, std::int64_t study_id, std::span<const WorldErrorRecord> errors) {
    Transaction transaction(database);
    RowWriter<WorldErrorRecord> rows(database, "world_error", "study_id");
    for (const WorldErrorRecord& error : errors) rows.write(error, study_id);
    hash_world_errors(database, study_id, errors);
    transaction.commit();
}

std::vector<WorldErrorRecord> read_world_errors(Database& database, std::int64_t study_id) {
    return read_rows<WorldErrorRecord>(database, "world_error", "condition, candidate_index, world",
                                       study_id);
}

void finish_world_study(Database& database, std::int64_t study_id,
                        const WorldRecommendationRecord& recommendation) {
    Transaction transaction(database);
    RowWriter<WorldRecommendationRecord>(database, "world_recommendation", "study_id")
        .write(recommendation, study_id);
    mark_complete(database, study_id);
    hash_conclusions(database, load_study_ids(database, study_id));
    transaction.commit();
}

std::optional<WorldRecommendationRecord> read_world_recommendation(Database& database,
                                                                   std::int64_t study_id) {
    const auto rows =
        read_rows<WorldRecommendationRecord>(database, "world_recommendation", "study_id", study_id);
    if (rows.empty()) return std::nullopt;
    return rows.front();
}

}  // namespace capstan::storage
