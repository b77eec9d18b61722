#include "capstan/reports/study_tables.h"

#include "capstan/storage/error.h"
#include "capstan/storage/report_queries.h"

namespace capstan::reports {

namespace {

std::vector<Table> read_tables(storage::Database& database, std::int64_t study_id) {
    std::vector<Table> tables;
    for (const storage::ReportQuery& query : storage::report_queries()) {
        storage::QueryResult result = storage::read_report_table(database, query, study_id);
        tables.push_back({std::string(query.table), std::string(query.meaning), std::move(result.columns),
                          std::move(result.rows)});
    }
    return tables;
}

}  // namespace

StudyTables::StudyTables(storage::Database& database, std::int64_t study_id)
    : Tables(read_tables(database, study_id)) {
    if ((*this)["study"].empty()) {
        throw storage::Error("There is no study " + std::to_string(study_id) + " in " +
                             database.path().string() +
                             ", so there is nothing to report. `capstan list` shows the studies.");
    }
}

}  // namespace capstan::reports
