#pragma once
// What a study report reads: one list of named tables, each one SELECT over one study.
// A table's name is its name everywhere: in JSON, in the page, and in the figures' specs.

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/storage/read_only_query.h"

namespace capstan::storage {

struct ReportQuery {
    std::string_view table;
    std::string_view meaning;
    std::string_view sql;  // ?1 is the study_id
};

const std::vector<ReportQuery>& report_queries();

// The database must have been opened with open_read_only. An unknown study gives empty tables.
QueryResult read_report_table(Database& database, const ReportQuery& query, std::int64_t study_id);

// A study (?1) to be compared with another one; ?2 is the word that its rows begin with.
// Its errors, by regime, noise label, layout family, method and count.
extern const std::string_view compared_errors_query;

// The best that needs no known direction, by count: one row a study, regime, noise label and count.
extern const std::string_view compared_best_query;

// What each recommends, by scope, regime and noise label.
extern const std::string_view compared_recommendations_query;

// What someone who watches a database asks again and again.
// The studies, with how far each has come, when it was begun and what people say about it; no parameter.
inline constexpr std::string_view studies_query = R"sql(
SELECT p.study_id, p.study AS name, p.status, p.units_done, p.units,
       ifnull((SELECT min(at_utc) FROM history h WHERE h.study_id = p.study_id AND event = 'begun'), '') AS begun_utc,
       ifnull(m.note, '') AS note, ifnull(m.tags, '') AS tags, ifnull(m.is_deleted, 0) AS is_deleted
FROM v_progress p LEFT JOIN study_mark m USING (study_id) ORDER BY p.study_id)sql";

// The diagnoses, newest first; no parameter.
inline constexpr std::string_view diagnoses_query = "SELECT * FROM v_diagnosis ORDER BY diagnosis_id DESC";

// The work units of a study (?1) with regime, instant and noise level, done or not.
inline constexpr std::string_view units_query = R"sql(
SELECT w.unit_index, w.stage, s.regime, s.sample, n.label AS noise, w.done
FROM work_unit w JOIN scenario s USING (scenario_id) JOIN noise_level n USING (noise_level_id)
WHERE w.study_id = ?1 ORDER BY w.unit_index)sql";

// The cable of a study (?1), segment by segment.
inline constexpr std::string_view cable_query =
    "SELECT segment, start_m, length_m, bend_radius_m, wrap_angle_rad FROM cable_segment "
    "WHERE study_id = ?1 ORDER BY segment";

// When a number of ours agrees with the paper's, for those who compare them and those who show the result.

// The paper rounds to 0.01 N, and reads some numbers off single draws of its own.
inline constexpr double paper_agreement_N = 0.03;
inline constexpr double paper_agreement_standard_errors = 2.0;

inline std::string paper_agreement_words() {
    char text[400];
    std::snprintf(
        text, sizeof text,
        "A row agrees where ours is within %g N (the paper's rounding and single draws) plus %g of our standard "
        "errors of the paper's number; with a bound, where ours is at most %g standard errors above it.",
        paper_agreement_N, paper_agreement_standard_errors, paper_agreement_standard_errors);
    return text;
}

// The configuration of the paper's experiment was partly fitted to its figures.
inline constexpr const char* paper_matched_words =
    "The instants, the reading of Table I's stiffness and the rule that an estimate may not move the blocked end were "
    "chosen by matching the paper's figures, so agreement is partly fitted. A reason is shown by an ablation, which "
    "`capstan paper estimation` prints, or is a guess.";

}  // namespace capstan::storage
