#pragma once
// A study's life in the database: begun, its work units written one by one, finished; listed, read, deleted.
// Every function that writes is one transaction: after a kill or an Error either all of its rows are there or
// none.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan::storage {

// ---- writing (begin_study.cpp, study_writer.cpp, study_life.cpp)

// Writes everything that is known before the first draw; the study is 'running' and none of its units is
// done. Returns its study_id; the study_id and status of the description are not read.
std::int64_t begin_study(Database& database, const StudyDescription& description);

// The same for the file of a shard, all studies in one transaction: a file is marked as a shard from its
// first row on. Returns the study_ids in the order of the descriptions, or nothing, and writes nothing, when
// the file holds a study already.
std::optional<std::vector<std::int64_t>> begin_shard(Database& database, const ShardRecord& shard,
                                                     const std::vector<StudyDescription>& descriptions);

// The same, or the studies that the file has already, where it is a file of this shard. An Error where it is
// another one, or holds complete studies.
std::vector<std::int64_t> begin_or_find_shard(Database& database, const ShardRecord& shard,
                                              const std::vector<StudyDescription>& descriptions);
std::string words_of(const ShardRecord& shard);  // "shard 2 of 8"

// Write a unit's results and mark it done. Refused when the unit is done already, or is another stage,
// scenario or noise level than the results.
void write_single_sensor(Database& database, std::int64_t study_id, int unit_index,
                         const SingleSensorResult& result);
void write_fusion(Database& database, std::int64_t study_id, int unit_index, const FusionResult& result);

// Writes the conclusions and makes the study 'complete'. Refused while a unit is not done, and the second
// time.
void finish_study(Database& database, std::int64_t study_id,
                  const std::vector<RecommendationRecord>& recommendations,
                  const std::vector<PaperComparisonRecord>& paper_comparison);

// Removes the study and everything that belongs to it.
void delete_study(Database& database, std::int64_t study_id);
/// The same without a trace in the history: a step on the way to a study, which nobody asked for. Its number
/// is free again.
void forget_study(Database& database, std::int64_t study_id);

// Into the trash and out of it. What is there keeps all its rows, but is found by no name, number or list.
void trash_study(Database& database, std::int64_t study_id);
void restore_study(Database& database, std::int64_t study_id);

// A note in words; tags are words with blanks between them. What is not given stays.
void annotate_study(Database& database, std::int64_t study_id, const std::optional<std::string>& note,
                    const std::optional<std::string>& tags);

// What the history calls the command that this process runs. Before any study is written.
void set_command(std::string command);

// ---- finding (study_life.cpp)

struct StudySummary {
    std::int64_t study_id = 0;
    std::string name;
    std::string status;  // 'running' or 'complete'
    int units_done = 0;
    int units = 0;
    std::string begun_utc;  // empty: before there was a history
    std::string note;
    std::string tags;
};

enum class Shelf { studies, trash };
std::vector<StudySummary> list_studies(Database& database, Shelf shelf = Shelf::studies);  // oldest first

// '3' is the study with that id; 'latest' the one begun last; any other text the last one begun under that
// name. No such study: an Error that lists what there is.
std::int64_t find_study(Database& database, std::string_view id_or_name_or_latest,
                        Shelf shelf = Shelf::studies);

// Which shard the file is; nothing for a file of complete studies.
std::optional<ShardRecord> read_shard(Database& database);

std::vector<int> pending_units(Database& database, std::int64_t study_id);  // unit_index, ascending

// ---- reading (load_study.cpp, study_reader.cpp)

// What begin_study wrote. Regimes are a set: they come back in the order of their names.
StudyDescription load_study(Database& database, std::int64_t study_id);

// In the order of knowledge, then sensor_node.
std::vector<SingleSensorRecord> read_single_sensor(Database& database, std::int64_t study_id,
                                                   int scenario_index, int noise_index);

// Weights in the order of sensor_node; cells in the order of set_index, then of the study's fusion methods.
FusionResult read_fusion(Database& database, std::int64_t study_id, int scenario_index, int noise_index);

// What a recommendation compares: every cell of a study at one noise level,
// in the order of scenario_index, set_index, then of the study's fusion methods.
struct CellSummary {
    int scenario_index = 0;
    int set_index = 0;
    std::string method;
    double mean_abs_error_N = 0;
    double standard_error_N = 0;
    std::vector<double> block_mean_abs_error_N;  // blocks
};

std::vector<CellSummary> read_cell_summaries(Database& database, std::int64_t study_id, int noise_index);

// A row of v_error_by_layout: averaged over a regime's instants and a family's variants.
struct LayoutErrorSummary {
    std::string regime;
    std::string family;
    int sensor_count = 0;
    std::string method;
    double mean_abs_error_N = 0;
    double standard_error_N = 0;
};

std::vector<LayoutErrorSummary> read_errors_by_layout(Database& database, std::int64_t study_id,
                                                      int noise_index);

std::vector<RecommendationRecord> read_recommendations(Database& database, std::int64_t study_id);
std::vector<PaperComparisonRecord> read_paper_comparison(Database& database, std::int64_t study_id);

}  // namespace capstan::storage
