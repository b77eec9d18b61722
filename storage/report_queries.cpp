#include "capstan/storage/report_queries.h"

namespace capstan::storage {

const std::vector<ReportQuery>& report_queries() {
    static const std::vector<ReportQuery> queries = {
        {"study", "The study and how it was made", R"sql(
SELECT study_id, name, status, program_version, seed, repetitions, segments, config_toml
FROM study WHERE study_id = ?1)sql"},

        {"cable_segment", "The cable from the proximal (motor) to the distal (load) end", R"sql(
SELECT segment, start_m, length_m, bend_radius_m, wrap_angle_rad
FROM cable_segment WHERE study_id = ?1 ORDER BY segment)sql"},

        {"regime", "The regimes of motion, their fraction of working time and number of instants", R"sql(
SELECT r.regime, r.duty_fraction, count(s.scenario_id) AS instants
FROM regime r LEFT JOIN scenario s USING (study_id, regime)
WHERE study_id = ?1 GROUP BY r.regime
ORDER BY CASE r.regime WHEN 'mass' THEN 0 WHEN 'partial_proximal' THEN 1 WHEN 'partial_distal' THEN 2 ELSE 3 END)sql"},

        {"noise_level", "The noise of the sensors", R"sql(
SELECT noise_level_id, noise_index, label, multiplicative_ratio, additive_N, bias_N
FROM noise_level WHERE study_id = ?1 ORDER BY noise_index)sql"},

        {"fusion_method", "The ways to fuse several sensors", R"sql(
SELECT method, title, knowledge, meaning
FROM fusion_method WHERE study_id = ?1 ORDER BY method_index)sql"},

        {"recommendation", "Where to put sensors, per noise level and scope", R"sql(
SELECT v.recommendation_id, r.noise_level_id, v.noise, v.scope, v.regime, v.layout, v.nodes, v.sensor_count,
       r.method, v.method_title, v.error_N, v.interval_low_N, v.interval_high_N, v.sentence
FROM v_recommendation v JOIN recommendation r USING (recommendation_id)
JOIN noise_level n USING (noise_level_id)
WHERE v.study_id = ?1
ORDER BY n.noise_index, CASE v.scope WHEN 'regime' THEN 0 WHEN 'minimax_regret' THEN 1 ELSE 2 END,
         CASE v.regime WHEN 'mass' THEN 0 WHEN 'partial_proximal' THEN 1 WHEN 'partial_distal' THEN 2 ELSE 3 END)sql"},

        {"recommendation_count", "The best choice at each number of sensors", R"sql(
SELECT r.recommendation_id, r.noise_level_id, r.scope, r.regime, c.sensor_count,
       coalesce((SELECT min(l.label) FROM layout l WHERE l.sensor_set_id = c.sensor_set_id), ss.nodes) AS layout,
       ss.nodes, f.title AS method_title, c.error_N, c.interval_low_N, c.interval_high_N,
       c.sensor_count = r.sensor_count AS recommended
FROM recommendation r JOIN recommendation_count c USING (recommendation_id)
JOIN sensor_set ss ON ss.sensor_set_id = c.sensor_set_id
JOIN fusion_method f ON f.study_id = r.study_id AND f.method = c.method
WHERE r.study_id = ?1 ORDER BY r.recommendation_id, c.sensor_count)sql"},

        {"recommendation_alternative", "What the draws cannot tell from the recommendation", R"sql(
SELECT r.recommendation_id, r.noise_level_id, r.scope, r.regime,
       coalesce((SELECT min(l.label) FROM layout l WHERE l.sensor_set_id = a.sensor_set_id), ss.nodes) AS layout,
       ss.nodes, f.title AS method_title, a.difference_N, a.interval_low_N, a.interval_high_N
FROM recommendation r JOIN recommendation_alternative a USING (recommendation_id)
JOIN sensor_set ss ON ss.sensor_set_id = a.sensor_set_id
JOIN fusion_method f ON f.study_id = r.study_id AND f.method = a.method
WHERE r.study_id = ?1 ORDER BY r.recommendation_id, a.difference_N)sql"},

        // The figure shows three sensors; longer cables than the paper's keep their full tables in the
        // database.
        {"tension_estimate",
         "Tension estimated from one sensor beside the true one (sensors at both ends and in the middle)",
         R"sql(
SELECT s.regime, e.noise_level_id, s.scenario_index, s.sample, s.motion, e.knowledge, e.sensor_node, e.node,
       n.arc_length_m, n.true_tension_N, e.mean_tension_N, e.tension_q025_N, e.tension_q975_N, e.mean_abs_error_N
FROM single_sensor_node e JOIN scenario s USING (scenario_id)
JOIN scenario_node n ON n.scenario_id = e.scenario_id AND n.node = e.node
JOIN study t ON t.study_id = s.study_id
WHERE s.study_id = ?1 AND e.sensor_node IN (1, t.segments / 2 + 1, t.segments + 1)
ORDER BY s.scenario_index, e.noise_level_id, e.knowledge, e.sensor_node, e.node)sql"},

        {"sensor_matrix",
         "e_ij: error at node j of the estimate from the sensor at node i, over a regime's instants",
         R"sql(
SELECT regime, noise_level_id, knowledge, sensor_node, node, mean_abs_error_N
FROM v_single_sensor_matrix WHERE study_id = ?1
ORDER BY regime, noise_level_id, knowledge, sensor_node, node)sql"},

        {"sensor_mean",
         "Error of one sensor alone, and how often its estimate is in doubt, over a regime's instants",
         R"sql(
SELECT s.regime, e.noise_level_id, e.knowledge, e.sensor_node, avg(e.mean_abs_error_N) AS mean_abs_error_N,
       avg(e.mean_abs_error_N) - 1.959963984540054 * sqrt(sum(e.standard_error_N * e.standard_error_N)) / count(*)
           AS interval_low_N,
       avg(e.mean_abs_error_N) + 1.959963984540054 * sqrt(sum(e.standard_error_N * e.standard_error_N)) / count(*)
           AS interval_high_N,
       avg(e.unverified_fraction) AS unverified_fraction, avg(e.ambiguous_fraction) AS ambiguous_fraction,
       avg(e.at_rest_fraction) AS at_rest_fraction
FROM single_sensor e JOIN scenario s USING (scenario_id)
WHERE s.study_id = ?1
GROUP BY s.regime, e.noise_level_id, e.knowledge, e.sensor_node
ORDER BY s.regime, e.noise_level_id, e.knowledge, e.sensor_node)sql"},

        {"error_by_layout", "Error by layout family, number of sensors and method, over a regime's instants",
         R"sql(
SELECT v.regime, v.noise_level_id, v.noise, v.family, v.sensor_count, v.method, v.method_title, v.knowledge, v.instants,
       v.mean_abs_error_N, v.standard_error_N, v.interval_low_N, v.interval_high_N, v.rms_error_N, v.bias_N,
       v.worst_node_error_N, v.unverified_fraction, v.ambiguous_fraction
FROM v_error_by_layout v JOIN fusion_method f ON f.study_id = v.study_id AND f.method = v.method
WHERE v.study_id = ?1
ORDER BY v.regime, v.noise_level_id, v.family, f.method_index, v.sensor_count)sql"},

        // As the paper's Figs 10-12: one instant at a time; a regime of many instants is shown by their mean
        // alone.
        {"error_by_instant", "Error by instant (or over all of them, where a regime has more than three)",
         R"sql(
WITH few AS (SELECT regime FROM scenario WHERE study_id = ?1 GROUP BY regime HAVING count(*) <= 3),
bound AS (
    SELECT s.regime, b.noise_level_id, s.sample, s.motion, l.family, l.sensor_count, avg(b.mean_abs_error_N) AS error_N
    FROM known_direction_bound b JOIN scenario s USING (scenario_id) JOIN layout l USING (sensor_set_id)
    WHERE s.study_id = ?1
    GROUP BY s.scenario_id, b.noise_level_id, l.family, l.sensor_count),
every AS (
    SELECT s.regime, c.noise_level_id, s.sample, s.motion, l.family, l.sensor_count, c.method, f.title AS method_title,
           f.knowledge, avg(c.mean_abs_error_N) AS mean_abs_error_N, avg(c.interval_low_N) AS interval_low_N,
           avg(c.interval_high_N) AS interval_high_N
    FROM cell c JOIN scenario s USING (scenario_id) JOIN layout l USING (sensor_set_id)
    JOIN fusion_method f ON f.study_id = s.study_id AND f.method = c.method
    WHERE s.study_id = ?1 AND s.regime IN few
    GROUP BY s.scenario_id, c.noise_level_id, l.family, l.sensor_count, c.method
    UNION ALL
    SELECT regime, noise_level_id, sample, motion, family, sensor_count, 'known_direction_bound',
           'Bound, direction known', 'bound', error_N, error_N, error_N
    FROM bound WHERE regime IN few)
SELECT regime, noise_level_id, sample, 'sample ' || sample || ', proximal end moves ' || motion AS instant,
       family, sensor_count, method, method_title, knowledge, mean_abs_error_N, interval_low_N, interval_high_N
FROM every
UNION ALL
SELECT regime, noise_level_id, -1, 'mean of ' || instants || ' instants', family, sensor_count, method, method_title,
       knowledge, mean_abs_error_N, interval_low_N, interval_high_N
FROM v_error_by_layout WHERE study_id = ?1 AND regime NOT IN few
UNION ALL
SELECT regime, noise_level_id, -1, 'mean of ' || (SELECT count(*) FROM scenario s WHERE s.study_id = ?1 AND s.regime = b.regime) ||
       ' instants', family, sensor_count, 'known_direction_bound', 'Bound, direction known', 'bound', avg(error_N),
       avg(error_N), avg(error_N)
FROM bound b WHERE regime NOT IN few GROUP BY regime, noise_level_id, family, sensor_count
ORDER BY 1, 2, 3, 5, 7, 6)sql"},

        // Only with several noise levels is there anything to compare.
        {"error_by_noise", "Error over the noise level, each method in its best layout family at that count",
         R"sql(
WITH ranked AS (
    SELECT v.*, n.noise_index, row_number() OVER (PARTITION BY v.regime, v.noise_level_id, v.method, v.sensor_count
                                                  ORDER BY v.mean_abs_error_N, v.family) AS place
    FROM v_error_by_layout v JOIN noise_level n USING (noise_level_id)
    WHERE v.study_id = ?1 AND (SELECT count(*) FROM noise_level WHERE study_id = ?1) > 1
      AND v.sensor_count IN (1, 3, (SELECT max(sensor_count) FROM layout WHERE study_id = ?1)))
SELECT regime, noise_index, noise, sensor_count, method, method_title, knowledge, family, mean_abs_error_N,
       interval_low_N, interval_high_N
FROM ranked WHERE place = 1 ORDER BY regime, sensor_count, method, noise_index)sql"},

        {"node_error", "Error at each node with the recommended sensors of each regime", R"sql(
WITH per_node AS (
    SELECT r.recommendation_id, e.node, avg(e.mean_abs_error_N) AS mean_abs_error_N, avg(e.bias_N) AS bias_N
    FROM recommendation r JOIN scenario s ON s.study_id = r.study_id AND s.regime = r.regime
    JOIN cell c ON c.scenario_id = s.scenario_id AND c.noise_level_id = r.noise_level_id
               AND c.sensor_set_id = r.sensor_set_id AND c.method = r.method
    JOIN cell_node e USING (cell_id)
    WHERE r.study_id = ?1 AND r.scope = 'regime'
    GROUP BY r.recommendation_id, e.node)
SELECT r.regime, r.noise_level_id, p.node, p.mean_abs_error_N, p.bias_N,
       p.node IN (SELECT value FROM json_each(ss.nodes)) AS has_sensor,
       p.mean_abs_error_N = max(p.mean_abs_error_N) OVER (PARTITION BY r.recommendation_id) AS worst,
       f.title AS method_title
FROM per_node p JOIN recommendation r USING (recommendation_id) JOIN sensor_set ss USING (sensor_set_id)
JOIN fusion_method f ON f.study_id = r.study_id AND f.method = r.method
ORDER BY r.recommendation_id, p.node)sql"},

        {"paper_comparison", "The paper's numbers beside ours", R"sql(
SELECT row_index, quantity, paper_N, relation, ours_N, standard_error_N,
       ours_N - 1.959963984540054 * standard_error_N AS interval_low_N,
       ours_N + 1.959963984540054 * standard_error_N AS interval_high_N,
       CASE relation WHEN '=' THEN ours_N - paper_N END AS difference_N, reason
FROM paper_comparison WHERE study_id = ?1 ORDER BY row_index)sql"},
    };
    return queries;
}

QueryResult read_report_table(Database& database, const ReportQuery& query, std::int64_t study_id) {
    // A study of many thousand cells takes a while to average; a report is worth waiting for.
    constexpr QueryLimits patient{.time_limit_s = 300};
    return run_read_only(database, query.sql, {study_id}, patient);
}

const std::string_view compared_errors_query = R"sql(
SELECT regime, noise, family, sensor_count, method, method_title, mean_abs_error_N, standard_error_N
FROM v_error_by_layout WHERE study_id = ?1 ORDER BY regime, noise, family, method, sensor_count)sql";

const std::string_view compared_best_query = R"sql(
WITH ranked AS (
    SELECT *, row_number() OVER (PARTITION BY regime, noise, sensor_count ORDER BY mean_abs_error_N, method) AS place
    FROM v_best_method WHERE study_id = ?1)
SELECT regime || ', ' || noise AS question, ?2 AS series, sensor_count, family, method_title, mean_abs_error_N AS error_N,
       interval_low_N, interval_high_N
FROM ranked WHERE place = 1)sql";

const std::string_view compared_recommendations_query = R"sql(
SELECT ?2 AS series, scope, regime, noise, nodes, sensor_count, method_title, error_N, interval_low_N, interval_high_N
FROM v_recommendation WHERE study_id = ?1)sql";

}  // namespace capstan::storage
