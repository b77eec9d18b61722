// Finding, finishing and deleting studies.
#include <optional>

#include "capstan/platform/parsed_number.h"
#include "capstan/storage/error.h"
#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/record_rows.h"
#include "capstan/storage/report_queries.h"
#include "capstan/storage/study_ids.h"
#include "capstan/storage/study_store.h"
#include "capstan/storage/transaction.h"

namespace capstan::storage {
namespace {

std::string sentence_of(const std::vector<StudySummary>& studies) {
    if (studies.empty()) return "It holds no study yet; `capstan study run` makes one.";
    std::string text = "It holds";
    for (const StudySummary& study : studies) {
        text += (&study == &studies.front() ? " " : ", ") + std::to_string(study.study_id) + " (" +
                study.name + ", " + study.status + ")";
    }
    return text + ".";
}

std::string command_here;  // of this process

void require_mark(Database& database, std::int64_t study_id) {
    load_study_ids(database, study_id);  // refuses a study that is not there
    Statement insert(database, "INSERT OR IGNORE INTO study_mark (study_id) VALUES (?1)");
    insert.bind(1, study_id);
    insert.run("mark the study");
}

void move_to(Database& database, std::int64_t study_id, Shelf shelf) {
    Transaction transaction(database);
    require_mark(database, study_id);
    Statement update(database, "UPDATE study_mark SET is_deleted = ?2 WHERE study_id = ?1");
    update.bind_all(study_id, shelf == Shelf::trash ? 1 : 0);
    update.run("mark the study");
    write_event(database, study_id, shelf == Shelf::trash ? "deleted" : "restored");
    transaction.commit();
}

void require_all_units_done(Database& database, std::int64_t study_id) {
    const auto pending = pending_units(database, study_id).size();
    if (pending == 0) return;
    throw Error("Study " + std::to_string(study_id) + " cannot be finished: " + std::to_string(pending) +
                " of its work units are not done. `capstan study resume` does them.");
}

// While the study still counts as running, the views work these out.
void keep_averages(Database& database, std::int64_t study_id) {
    for (const std::string table : {"layout_error", "sensor_matrix"}) {
        Statement insert(database, "INSERT INTO " + table + " SELECT * FROM v_running_" + table +
                                       " WHERE study_id = ?1 ORDER BY 1, 2, 3, 4, 5, 6");
        insert.bind(1, study_id);
        insert.run("keep the averages of the study");
    }
}

void write_recommendations(Database& database, const StudyIds& ids,
                           const std::vector<RecommendationRecord>& recommendations) {
    RowWriter<RecommendationRecord> rows(database, "recommendation",
                                         "recommendation_id, study_id, noise_level_id, sensor_set_id");
    RowWriter<RecommendationCountRecord> count_rows(database, "recommendation_count",
                                                    "recommendation_id, sensor_set_id");
    RowWriter<RecommendationAlternativeRecord> alternative_rows(database, "recommendation_alternative",
                                                                "recommendation_id, sensor_set_id");
    const auto set_id = [&](int set_index) { return id_at(ids.sensor_sets, set_index, "sensor set"); };
    std::int64_t number = 0;
    for (const RecommendationRecord& recommendation : recommendations) {
        const std::int64_t id = numbered_within_study(ids.study_id, number++);
        rows.write(recommendation, id, ids.study_id,
                   id_at(ids.noise_levels, recommendation.noise_index, "noise level"),
                   set_id(recommendation.set_index));
        for (const auto& count : recommendation.counts) count_rows.write(count, id, set_id(count.set_index));
        for (const auto& other : recommendation.alternatives) {
            alternative_rows.write(other, id, set_id(other.set_index));
        }
    }
}

}  // namespace

void mark_complete(Database& database, std::int64_t study_id) {
    Statement update(database,
                     "UPDATE study SET status = 'complete' WHERE study_id = ?1 AND status = 'running'");
    update.bind(1, study_id);
    update.run("finish the study");
    if (sqlite3_changes(database.connection()) == 0) {
        throw Error("Study " + std::to_string(study_id) + " is complete already; its conclusions stay.");
    }
    write_event(database, study_id, "completed");
}

void set_command(std::string command) {
    command_here = std::move(command);
}

void write_event(Database& database, std::int64_t study_id, std::string_view event) {
    Statement insert(
        database,
        "INSERT INTO history (study_id, study, event, at_utc, command) SELECT study_id, name, ?2, "
        "strftime('%Y-%m-%dT%H:%M:%SZ', 'now'), ?3 FROM study WHERE study_id = ?1");
    insert.bind_all(study_id, event, std::string_view(command_here));
    insert.run("write the history");
}

std::vector<StudySummary> list_studies(Database& database, Shelf shelf) {
    Statement select(database,
                     std::string("SELECT * FROM (") + std::string(studies_query) + ") WHERE is_deleted = ?1");
    select.bind(1, shelf == Shelf::trash ? 1 : 0);
    std::vector<StudySummary> studies;
    while (select.step()) {
        studies.push_back({select.get<std::int64_t>(0), select.get<std::string>(1),
                           select.get<std::string>(2), select.get<int>(3), select.get<int>(4),
                           select.get<std::string>(5), select.get<std::string>(6),
                           select.get<std::string>(7)});
    }
    return studies;
}

std::int64_t find_study(Database& database, std::string_view id_or_name_or_latest, Shelf shelf) {
    const std::vector<StudySummary> studies = list_studies(database, shelf);
    const std::optional<std::int64_t> id = parsed_number<std::int64_t>(id_or_name_or_latest);
    for (const StudySummary& study : studies) {
        if (id && study.study_id == *id) return *id;
    }
    // Before the names: it is what a command takes that is given none.
    if (id_or_name_or_latest == "latest" && !studies.empty()) return studies.back().study_id;
    for (auto study = studies.rbegin(); study != studies.rend(); ++study) {
        if (study->name == id_or_name_or_latest) return study->study_id;
    }
    throw Error(database.path().string() +
                (shelf == Shelf::trash ? " has no deleted study '" : " has no study '") +
                std::string(id_or_name_or_latest) + "'. " +
                (shelf == Shelf::trash && studies.empty() ? "Its trash is empty." : sentence_of(studies)));
}

std::optional<ShardRecord> read_shard(Database& database) {
    Statement select(database, "SELECT shard, shards FROM shard");
    if (!select.step()) return std::nullopt;
    return ShardRecord{select.get<int>(0), select.get<int>(1)};
}

std::vector<int> pending_units(Database& database, std::int64_t study_id) {
    Statement select(database,
                     "SELECT unit_index FROM work_unit WHERE study_id = ?1 AND done = 0 ORDER BY unit_index");
    select.bind(1, study_id);
    std::vector<int> units;
    while (select.step()) units.push_back(select.get<int>(0));
    return units;
}

void finish_study(Database& database, std::int64_t study_id,
                  const std::vector<RecommendationRecord>& recommendations,
                  const std::vector<PaperComparisonRecord>& paper_comparison) {
    Transaction transaction(database);
    const StudyIds ids = load_study_ids(database, study_id);
    require_all_units_done(database, study_id);
    keep_averages(database, study_id);
    mark_complete(database, study_id);
    write_recommendations(database, ids, recommendations);
    RowWriter<PaperComparisonRecord> rows(database, "paper_comparison", "study_id, row_index");
    int row_index = 0;
    for (const PaperComparisonRecord& row : paper_comparison) rows.write(row, study_id, row_index++);
    hash_conclusions(database, ids);
    transaction.commit();
}

void annotate_study(Database& database, std::int64_t study_id, const std::optional<std::string>& note,
                    const std::optional<std::string>& tags) {
    Transaction transaction(database);
    require_mark(database, study_id);
    Statement update(
        database,
        "UPDATE study_mark SET note = ifnull(?2, note), tags = ifnull(?3, tags) WHERE study_id = ?1");
    update.bind(1, study_id);
    if (note) update.bind(2, std::string_view(*note));
    if (tags) update.bind(3, std::string_view(*tags));
    update.run("write the note");
    transaction.commit();
}

void trash_study(Database& database, std::int64_t study_id) {
    move_to(database, study_id, Shelf::trash);
}

void restore_study(Database& database, std::int64_t study_id) {
    move_to(database, study_id, Shelf::studies);
}

void delete_study(Database& database, std::int64_t study_id) {
    Transaction transaction(database);
    load_study_ids(database, study_id);  // refuses a study that is not there
    write_event(database, study_id, "removed");
    Statement statement(database,
                        "DELETE FROM study WHERE study_id = ?1");  // the rest follows by ON DELETE CASCADE
    statement.bind(1, study_id);
    statement.run("delete the study");
    transaction.commit();
}

void forget_study(Database& database, std::int64_t study_id) {
    Transaction transaction(database);
    load_study_ids(database, study_id);
    for (const char* sql :
         {"DELETE FROM study WHERE study_id = ?1", "DELETE FROM history WHERE study_id = ?1"}) {
        Statement statement(database, sql);
        statement.bind(1, study_id);
        statement.run("forget the study");
    }
    transaction.commit();
}

}  // namespace capstan::storage
