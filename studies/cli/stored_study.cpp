#include "capstan/cli/stored_study.h"

#include <fmt/format.h>

#include "capstan/cli/config_reader.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

StoredStudy load_stored_study(storage::Database& database, std::int64_t study_id) {
    StoredStudy stored{storage::load_study(database, study_id), {}};
    const std::string where =
        fmt::format("{}, stored configuration of study {}", database.path().string(), study_id);
    stored.plan = parse_config(stored.description.study.config_toml, where).plan;
    return stored;
}

}  // namespace capstan::cli
