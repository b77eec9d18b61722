#pragma once
// From schema version 3 to 4, as version 4 was: what later versions change, they change in steps of their
// own.

namespace capstan::storage {

// Keeps what version 3's views say of the complete studies, once; the new views read it.
inline constexpr const char* migration_to_4 = R"sql(
CREATE TABLE layout_error (
    study_id           INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    regime             TEXT    NOT NULL,
    noise_level_id     INTEGER NOT NULL,
    family             TEXT    NOT NULL,
    sensor_count       INTEGER NOT NULL,
    method             TEXT    NOT NULL,
    instants           INTEGER NOT NULL,
    mean_abs_error_N   REAL    NOT NULL,
    standard_error_N   REAL    NOT NULL,
    rms_error_N        REAL    NOT NULL,
    bias_N             REAL    NOT NULL,
    worst_node_error_N REAL    NOT NULL,
    unverified_fraction   REAL    NOT NULL,
    ambiguous_fraction    REAL    NOT NULL,
    best               INTEGER NOT NULL CHECK (best IN (0, 1)),
    PRIMARY KEY (study_id, regime, noise_level_id, family, sensor_count, method)
) STRICT, WITHOUT ROWID;
CREATE TABLE sensor_matrix (
    study_id         INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    regime           TEXT    NOT NULL,
    noise_level_id   INTEGER NOT NULL,
    knowledge        TEXT    NOT NULL,
    sensor_node      INTEGER NOT NULL,
    node             INTEGER NOT NULL,
    mean_abs_error_N REAL    NOT NULL,
    PRIMARY KEY (study_id, regime, noise_level_id, knowledge, sensor_node, node)
) STRICT, WITHOUT ROWID;
INSERT INTO layout_error
SELECT study_id, regime, noise_level_id, family, sensor_count, method, instants, mean_abs_error_N, standard_error_N,
       rms_error_N, bias_N, worst_node_error_N, unverified_fraction, ambiguous_fraction,
       knowledge <> 'direction_known' AND
       row_number() OVER (PARTITION BY study_id, regime, noise_level_id, family, sensor_count
                          ORDER BY knowledge = 'direction_known', mean_abs_error_N, method) = 1
FROM v_error_by_layout WHERE study_id IN (SELECT study_id FROM study WHERE status = 'complete');
INSERT INTO sensor_matrix
SELECT study_id, regime, noise_level_id, knowledge, sensor_node, node, mean_abs_error_N
FROM v_single_sensor_matrix WHERE study_id IN (SELECT study_id FROM study WHERE status = 'complete');
CREATE INDEX best_layout_error ON layout_error (study_id, regime, noise_level_id, family, sensor_count, method,
                                                mean_abs_error_N, standard_error_N) WHERE best = 1;
DROP VIEW v_best_method;
DROP VIEW v_error_by_layout;
DROP VIEW v_single_sensor_matrix;
CREATE VIEW v_running_layout_error AS
WITH per_instant AS (
    SELECT s.study_id, s.regime, c.scenario_id, c.noise_level_id, l.family, l.sensor_count, c.method,
           avg(c.mean_abs_error_N) AS mean_abs_error_N, avg(c.standard_error_N) AS standard_error_N,
           avg(c.rms_error_N) AS rms_error_N, avg(c.bias_N) AS bias_N, max(c.worst_node_error_N) AS worst_node_error_N,
           avg(c.unverified_fraction) AS unverified_fraction, avg(c.ambiguous_fraction) AS ambiguous_fraction
    FROM study t CROSS JOIN scenario s USING (study_id) CROSS JOIN cell c USING (scenario_id)
    CROSS JOIN layout l USING (sensor_set_id)
    WHERE t.status = 'running'
    GROUP BY s.study_id, s.regime, c.scenario_id, c.noise_level_id, l.family, l.sensor_count, c.method),
over_instants AS (
    SELECT study_id, regime, noise_level_id, family, sensor_count, method, count(*) AS instants,
           avg(mean_abs_error_N) AS mean_abs_error_N,
           sqrt(sum(standard_error_N * standard_error_N)) / count(*) AS standard_error_N, avg(rms_error_N) AS rms_error_N,
           avg(bias_N) AS bias_N, max(worst_node_error_N) AS worst_node_error_N, avg(unverified_fraction) AS unverified_fraction,
           avg(ambiguous_fraction) AS ambiguous_fraction
    FROM per_instant GROUP BY study_id, regime, noise_level_id, family, sensor_count, method)
SELECT o.*, f.knowledge <> 'direction_known' AND
       row_number() OVER (PARTITION BY o.study_id, o.regime, o.noise_level_id, o.family, o.sensor_count
                          ORDER BY f.knowledge = 'direction_known', o.mean_abs_error_N, o.method) = 1 AS best
FROM over_instants o JOIN fusion_method f USING (study_id, method);
CREATE VIEW v_error_by_layout AS
SELECT e.study_id, t.name AS study, e.regime, e.noise_level_id, n.label AS noise, e.family, e.sensor_count, e.method,
       f.title AS method_title, f.knowledge, e.instants, e.mean_abs_error_N, e.standard_error_N,
       e.mean_abs_error_N - 1.959963984540054 * e.standard_error_N AS interval_low_N,
       e.mean_abs_error_N + 1.959963984540054 * e.standard_error_N AS interval_high_N,
       e.rms_error_N, e.bias_N, e.worst_node_error_N, e.unverified_fraction, e.ambiguous_fraction
FROM (SELECT * FROM layout_error UNION ALL SELECT * FROM v_running_layout_error) e
CROSS JOIN study t USING (study_id) CROSS JOIN noise_level n USING (noise_level_id) CROSS JOIN fusion_method f USING (study_id, method);
CREATE VIEW v_best_method AS
SELECT e.study_id, t.name AS study, e.regime, e.noise_level_id, n.label AS noise, e.family, e.sensor_count, e.method,
       f.title AS method_title, e.mean_abs_error_N,
       e.mean_abs_error_N - 1.959963984540054 * e.standard_error_N AS interval_low_N,
       e.mean_abs_error_N + 1.959963984540054 * e.standard_error_N AS interval_high_N
FROM (SELECT study_id, regime, noise_level_id, family, sensor_count, method, mean_abs_error_N, standard_error_N
      FROM layout_error WHERE best = 1
      UNION ALL
      SELECT study_id, regime, noise_level_id, family, sensor_count, method, mean_abs_error_N, standard_error_N
      FROM v_running_layout_error WHERE best = 1) e
CROSS JOIN study t USING (study_id) CROSS JOIN noise_level n USING (noise_level_id) CROSS JOIN fusion_method f USING (study_id, method);
CREATE VIEW v_running_sensor_matrix AS
SELECT s.study_id, s.regime, e.noise_level_id, e.knowledge, e.sensor_node, e.node, avg(e.mean_abs_error_N) AS mean_abs_error_N
FROM study t CROSS JOIN scenario s USING (study_id) CROSS JOIN single_sensor_node e USING (scenario_id)
WHERE t.status = 'running'
GROUP BY s.study_id, s.regime, e.noise_level_id, e.knowledge, e.sensor_node, e.node;
CREATE VIEW v_single_sensor_matrix AS
SELECT e.study_id, t.name AS study, e.regime, e.noise_level_id, n.label AS noise, e.knowledge, e.sensor_node, e.node,
       e.mean_abs_error_N
FROM (SELECT * FROM sensor_matrix UNION ALL SELECT * FROM v_running_sensor_matrix) e
CROSS JOIN study t USING (study_id) CROSS JOIN noise_level n USING (noise_level_id);
)sql";

}  // namespace capstan::storage
