#include "capstan/placement/stored_study.h"

#include "capstan/config/config_reader.h"
#include "capstan/storage/study_store.h"

namespace capstan {

StoredStudy load_stored_study(storage::Database& database, std::int64_t study_id) {
    StoredStudy stored{storage::load_study(database, study_id), {}};
    const std::string where =
        database.path().string() + ", stored configuration of study " + std::to_string(study_id);
    stored.plan = config::parse_config(stored.description.study.config_toml, where).plan;
    return stored;
}

}  // namespace capstan
