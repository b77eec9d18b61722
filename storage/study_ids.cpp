#include "capstan/storage/study_ids.h"

#include <algorithm>

#include "capstan/storage/error.h"
#include "capstan/storage/statement.h"

namespace capstan::storage {
namespace {

template <class Value>
std::vector<Value> values_of_study(Database& database, std::string_view sql, std::int64_t study_id) {
    Statement statement(database, sql);
    statement.bind(1, study_id);
    std::vector<Value> values;
    while (statement.step()) values.push_back(statement.get<Value>(0));
    return values;
}

}  // namespace

StudyIds load_study_ids(Database& database, std::int64_t study_id) {
    Statement study(database, "SELECT 1 FROM study WHERE study_id = ?1");
    study.bind(1, study_id);
    if (!study.step()) {
        throw Error(database.path().string() + " holds no study " + std::to_string(study_id) +
                    ". `capstan study list` shows what it holds.");
    }
    const auto ids = [&](std::string_view sql) {
        return values_of_study<std::int64_t>(database, sql, study_id);
    };
    return {study_id, ids("SELECT scenario_id FROM scenario WHERE study_id = ?1 ORDER BY scenario_index"),
            ids("SELECT noise_level_id FROM noise_level WHERE study_id = ?1 ORDER BY noise_index"),
            ids("SELECT sensor_set_id FROM sensor_set WHERE study_id = ?1 ORDER BY set_index"),
            values_of_study<std::string>(
                database, "SELECT method FROM fusion_method WHERE study_id = ?1 ORDER BY method_index",
                study_id)};
}

std::int64_t id_at(const std::vector<std::int64_t>& ids, int index, std::string_view what) {
    if (index < 0 || static_cast<std::size_t>(index) >= ids.size()) {
        throw Error("The study has no " + std::string(what) + " " + std::to_string(index) + ": it has " +
                    std::to_string(ids.size()) + ", counted from 0.");
    }
    return ids[static_cast<std::size_t>(index)];
}

int index_of(const std::vector<std::int64_t>& ids, std::int64_t id) {
    return static_cast<int>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

std::int64_t numbered_within_study(std::int64_t study_id, std::int64_t number) {
    constexpr std::int64_t numbers_per_study = 1'000'000'000;
    if (number >= numbers_per_study)
        throw Error("A study may have at most a billion cells. Split the study.");
    return study_id * numbers_per_study + number;
}

std::int64_t cell_id(const StudyIds& ids, int scenario_index, int noise_index, int set_index,
                     std::string_view method) {
    const auto found = std::find(ids.methods.begin(), ids.methods.end(), method);
    if (found == ids.methods.end()) {
        throw Error("The study has no fusion method '" + std::string(method) + "'.");
    }
    const auto size = [](const auto& values) { return static_cast<std::int64_t>(values.size()); };
    const std::int64_t instant = scenario_index * size(ids.noise_levels) + noise_index;
    const std::int64_t set = instant * size(ids.sensor_sets) + set_index;
    return numbered_within_study(ids.study_id, set * size(ids.methods) + (found - ids.methods.begin()));
}

}  // namespace capstan::storage
