#include "capstan/cli/service_answers.h"

#include "capstan/cable/invalid_input.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/recommendation_words.h"
#include "capstan/cli/study_words.h"
#include "capstan/cli/text_table.h"
#include "capstan/cli/usage_error.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_studies.h"
#include "capstan/config/config_writer.h"
#include "capstan/placement/stored_study.h"
#include "capstan/reports/plain_tables.h"
#include "capstan/service/bad_request.h"
#include "capstan/storage/error.h"

namespace capstan::cli {

namespace {

std::vector<StudyPlan> studies_of(const std::string& toml, const std::string& name) {
    try {
        config::ReadConfig config = config::parse_config(toml, name);
        return config::runnable_studies(config);
    } catch (const UsageError& error) {  // with it the problems of a configuration
        throw service::BadRequest(error.what());
    } catch (const InvalidInput& error) {
        throw service::BadRequest(error.what());
    }
}

std::string recommendation_json(storage::Database& database, std::int64_t study_id) {
    try {
        return json_text(in_json(read_conclusions(database, study_id)));
    } catch (const storage::Error& error) {  // not complete yet
        throw service::BadRequest(error.what(), 409);
    }
}

}  // namespace

service::Answers service_answers() {
    return {study_json,
            recommendation_json,
            as_json,
            [](const storage::QueryResult& rows) { return reports::csv_text(rows.columns, rows.rows); },
            studies_of,
            [](storage::Database& database, std::int64_t study_id) {
                return load_stored_study(database, study_id).plan;
            }};
}

}  // namespace capstan::cli
