// Finding, finishing and deleting studies.
#include <charconv>
#include <optional>

#include "capstan/storage/error.h"
#include "capstan/storage/record_rows.h"
#include "capstan/storage/study_ids.h"
#include "capstan/storage/study_store.h"
#include "capstan/storage/transaction.h"

namespace capstan::storage {
namespace {

std::optional<std::int64_t> as_id(std::string_view text) {
    std::int64_t id = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return id;
}

std::string sentence_of(const std::vector<StudySummary>& studies) {
    if (studies.empty()) return "It holds no study yet; `capstan study run` makes one.";
    std::string text = "It holds";
    for (const StudySummary& study : studies) {
        text += (&study == &studies.front() ? " " : ", ") + std::to_string(study.study_id) + " (" +
                study.name + ", " + study.status + ")";
    }
    return text + ".";
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
}

std::vector<StudySummary> list_studies(Database& database) {
    Statement select(database,
                     "SELECT study_id, study, status, units_done, units FROM v_progress ORDER BY study_id");
    std::vector<StudySummary> studies;
    while (select.step()) {
        studies.push_back({select.get<std::int64_t>(0), select.get<std::string>(1),
                           select.get<std::string>(2), select.get<int>(3), select.get<int>(4)});
    }
    return studies;
}

std::int64_t find_study(Database& database, std::string_view id_or_name_or_latest) {
    const std::vector<StudySummary> studies = list_studies(database);
    const std::optional<std::int64_t> id = as_id(id_or_name_or_latest);
    for (const StudySummary& study : studies) {
        if (id && study.study_id == *id) return *id;
    }
    for (auto study = studies.rbegin(); study != studies.rend(); ++study) {
        if (study->name == id_or_name_or_latest) return study->study_id;
    }
    if (id_or_name_or_latest == "latest" && !studies.empty()) return studies.back().study_id;
    throw Error(database.path().string() + " has no study '" + std::string(id_or_name_or_latest) + "'. " +
                sentence_of(studies));
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
    transaction.commit();
}

void delete_study(Database& database, std::int64_t study_id) {
    Transaction transaction(database);
    load_study_ids(database, study_id);  // refuses a study that is not there
    Statement statement(database,
                        "DELETE FROM study WHERE study_id = ?1");  // the rest follows by ON DELETE CASCADE
    statement.bind(1, study_id);
    statement.run("delete the study");
    transaction.commit();
}

}  // namespace capstan::storage
