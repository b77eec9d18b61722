#pragma once
// Row ids behind the positions that records use.
//
// Ids are assigned, never left to SQLite: what begin_study writes is numbered on in the order of the
// description; cells and recommendations get an id from their address. So the ids do not depend on the order
// in which units are finished, and the same studies make the same tables.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/storage/database.h"

namespace capstan::storage {

struct StudyIds {
    std::int64_t study_id = 0;
    std::vector<std::int64_t> scenarios;     // scenario_index -> scenario_id, ascending
    std::vector<std::int64_t> noise_levels;  // noise_index -> noise_level_id, ascending
    std::vector<std::int64_t> sensor_sets;   // set_index -> sensor_set_id, ascending
    std::vector<std::string> methods;        // method_index -> method
};

// Throws an Error if the study does not exist.
StudyIds load_study_ids(Database& database, std::int64_t study_id);

// The id at a position; an Error names what is missing.
std::int64_t id_at(const std::vector<std::int64_t>& ids, int index, std::string_view what);
int index_of(const std::vector<std::int64_t>& ids, std::int64_t id);

// Makes a running study complete; an Error if it is complete already.
void mark_complete(Database& database, std::int64_t study_id);

// Into the history: 'begun', 'completed', ... Within the caller's transaction.
void write_event(Database& database, std::int64_t study_id, std::string_view event);

// Readable ids: study 2's cell number 17 is 2'000'000'017.
std::int64_t numbered_within_study(std::int64_t study_id, std::int64_t number);

std::int64_t cell_id(const StudyIds& ids, int scenario_index, int noise_index, int set_index,
                     std::string_view method);

}  // namespace capstan::storage
