-- A file of version 4 as version 3 had it: what version 4 added is taken away, the views are those of then.
DROP VIEW v_best_method;
DROP VIEW v_error_by_layout;
DROP VIEW v_single_sensor_matrix;
DROP VIEW v_running_layout_error;
DROP VIEW v_running_sensor_matrix;
DROP TABLE layout_error;
DROP TABLE sensor_matrix;
CREATE VIEW v_error_by_layout AS
WITH per_instant AS (
    SELECT s.study_id, s.regime, c.scenario_id, c.noise_level_id, l.family, l.sensor_count, c.method,
           avg(c.mean_abs_error_N) AS mean_abs_error_N, avg(c.standard_error_N) AS standard_error_N,
           avg(c.rms_error_N) AS rms_error_N, avg(c.bias_N) AS bias_N, max(c.worst_node_error_N) AS worst_node_error_N,
           avg(c.unverified_fraction) AS unverified_fraction, avg(c.ambiguous_fraction) AS ambiguous_fraction
    FROM cell c JOIN scenario s USING (scenario_id) JOIN layout l USING (sensor_set_id)
    GROUP BY s.study_id, s.regime, c.scenario_id, c.noise_level_id, l.family, l.sensor_count, c.method)
SELECT p.study_id, t.name AS study, p.regime, p.noise_level_id, n.label AS noise, p.family, p.sensor_count, p.method,
       f.title AS method_title, f.knowledge, count(*) AS instants,
       avg(p.mean_abs_error_N) AS mean_abs_error_N,
       sqrt(sum(p.standard_error_N * p.standard_error_N)) / count(*) AS standard_error_N,
       avg(p.mean_abs_error_N) - 1.959963984540054 * sqrt(sum(p.standard_error_N * p.standard_error_N)) / count(*) AS interval_low_N,
       avg(p.mean_abs_error_N) + 1.959963984540054 * sqrt(sum(p.standard_error_N * p.standard_error_N)) / count(*) AS interval_high_N,
       avg(p.rms_error_N) AS rms_error_N, avg(p.bias_N) AS bias_N, max(p.worst_node_error_N) AS worst_node_error_N,
       avg(p.unverified_fraction) AS unverified_fraction, avg(p.ambiguous_fraction) AS ambiguous_fraction
FROM per_instant p JOIN study t USING (study_id) JOIN noise_level n USING (noise_level_id)
JOIN fusion_method f ON f.study_id = p.study_id AND f.method = p.method
GROUP BY p.study_id, p.regime, p.noise_level_id, p.family, p.sensor_count, p.method;
CREATE VIEW v_best_method AS
SELECT study_id, study, regime, noise_level_id, noise, family, sensor_count, method, method_title,
       mean_abs_error_N, interval_low_N, interval_high_N
FROM (SELECT *, row_number() OVER (PARTITION BY study_id, regime, noise_level_id, family, sensor_count
                                   ORDER BY mean_abs_error_N, method) AS place
      FROM v_error_by_layout WHERE knowledge <> 'direction_known')
WHERE place = 1;
CREATE VIEW v_single_sensor_matrix AS
SELECT s.study_id, t.name AS study, s.regime, e.noise_level_id, n.label AS noise, e.knowledge, e.sensor_node, e.node,
       avg(e.mean_abs_error_N) AS mean_abs_error_N
FROM single_sensor_node e JOIN scenario s USING (scenario_id) JOIN study t USING (study_id)
JOIN noise_level n USING (noise_level_id)
GROUP BY s.study_id, s.regime, e.noise_level_id, e.knowledge, e.sensor_node, e.node;
PRAGMA user_version = 3;
