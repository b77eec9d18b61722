#pragma once
// What someone who watches a database asks again and again: small SELECTs with names.

#include <string_view>

namespace capstan::storage {

// The studies, with how far each has come; no parameter.
inline constexpr std::string_view studies_query =
    "SELECT study_id, study AS name, status, units_done, units FROM v_progress ORDER BY study_id";

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

}  // namespace capstan::storage
