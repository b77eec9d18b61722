-- The results database of capstan, version 3. One home: everything that stores or reads goes through this text.
--
-- Rules: every physical column ends in its unit (N, m, rad, s); a share or a ratio has no unit and says so in its
-- name; _in_unit is in the unit that the row's column 'unit' names; nodes are numbered from 1 (proximal, motor) to
-- segments + 1 (distal, load); there is no clock in any table, so the same program, configuration and seed give the
-- same bits.

CREATE TABLE study (
    study_id        INTEGER PRIMARY KEY,
    name            TEXT    NOT NULL,
    config_toml     TEXT    NOT NULL,              -- every key written out, defaults included
    program_version TEXT    NOT NULL,
    seed            INTEGER NOT NULL,              -- 64 bits, as SQLite keeps them: signed
    repetitions     INTEGER NOT NULL CHECK (repetitions > 0),
    segments        INTEGER NOT NULL CHECK (segments > 0),
    status          TEXT    NOT NULL CHECK (status IN ('running', 'complete'))  -- running: begun, not ended; resume it
) STRICT;

CREATE TABLE cable_segment (
    study_id       INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    segment        INTEGER NOT NULL CHECK (segment > 0),
    start_m        REAL    NOT NULL,               -- arc length from the proximal end
    length_m       REAL    NOT NULL CHECK (length_m > 0),
    bend_radius_m  REAL,                           -- NULL: straight
    wrap_angle_rad REAL    NOT NULL,
    PRIMARY KEY (study_id, segment)
) STRICT, WITHOUT ROWID;

CREATE TABLE regime (
    study_id    INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    regime      TEXT    NOT NULL CHECK (regime IN ('mass', 'partial_proximal', 'partial_distal', 'partial_both')),
    duty_share  REAL    NOT NULL CHECK (duty_share BETWEEN 0 AND 1),  -- share of working time; sums to 1 in a study
    PRIMARY KEY (study_id, regime)
) STRICT, WITHOUT ROWID;

-- A scenario is one instant of the true motion in one regime.
CREATE TABLE scenario (
    scenario_id              INTEGER PRIMARY KEY,
    study_id                 INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    scenario_index           INTEGER NOT NULL,     -- 0, 1, ... in the order of the configuration
    regime                   TEXT    NOT NULL,
    sample                   INTEGER NOT NULL,     -- the instant, as a sample number of the motion
    time_s                   REAL    NOT NULL,
    motion                   TEXT    NOT NULL CHECK (motion IN ('forward', 'backward')),  -- of the proximal end
    proximal_displacement_m  REAL    NOT NULL,
    proximal_increment_m     REAL    NOT NULL,     -- since the sample before
    UNIQUE (study_id, scenario_index),
    FOREIGN KEY (study_id, regime) REFERENCES regime (study_id, regime) ON DELETE CASCADE
) STRICT;

CREATE TABLE scenario_node (
    scenario_id             INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,
    node                    INTEGER NOT NULL CHECK (node > 0),
    arc_length_m            REAL    NOT NULL,
    true_tension_N          REAL    NOT NULL,
    true_displacement_m     REAL    NOT NULL,
    previous_tension_N      REAL    NOT NULL,      -- one sample earlier: what every estimate starts from
    previous_displacement_m REAL    NOT NULL,
    direction               INTEGER NOT NULL CHECK (direction IN (-1, 0, 1)),  -- of the node's true motion
    PRIMARY KEY (scenario_id, node)
) STRICT, WITHOUT ROWID;

-- reading = tension * (1 + multiplicative_ratio * e1) + additive_N * e2 + bias_N * e3, e1, e2, e3 standard normal;
-- e3 is drawn once per sensor and repetition, and is the same at every instant. The reading is then rounded to whole
-- steps of quantisation_N and ends at range_N.
CREATE TABLE noise_level (
    noise_level_id       INTEGER PRIMARY KEY,
    study_id             INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    noise_index          INTEGER NOT NULL,
    label                TEXT    NOT NULL,         -- for people: '10 %', '0.2 N'
    multiplicative_ratio REAL    NOT NULL CHECK (multiplicative_ratio >= 0),
    additive_N           REAL    NOT NULL CHECK (additive_N >= 0),
    bias_N               REAL    NOT NULL CHECK (bias_N >= 0),
    quantisation_N       REAL    CHECK (quantisation_N >= 0),  -- 0: none; NULL: stored before version 3, see config_toml
    range_N              REAL    CHECK (range_N > 0),          -- the largest reading; NULL as above
    UNIQUE (study_id, noise_index)
) STRICT;

CREATE TABLE fusion_method (
    study_id     INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    method       TEXT    NOT NULL,                 -- 'mean', 'w_mean_r', 'posterior_mean', ...
    method_index INTEGER NOT NULL,
    title        TEXT    NOT NULL,                 -- as figures write it: 'W Mean-R'
    knowledge    TEXT    NOT NULL CHECK (knowledge IN ('direction_known', 'direction_unknown', 'feasible_curve')),
    meaning      TEXT    NOT NULL,
    PRIMARY KEY (study_id, method)
) STRICT, WITHOUT ROWID;

CREATE TABLE sensor_set (
    sensor_set_id INTEGER PRIMARY KEY,
    study_id      INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    set_index     INTEGER NOT NULL,
    sensor_count  INTEGER NOT NULL CHECK (sensor_count > 0),
    nodes         TEXT    NOT NULL CHECK (json_valid(nodes)),  -- '[1,6,11]'
    UNIQUE (study_id, set_index),
    UNIQUE (study_id, nodes)
) STRICT;

-- A layout names a sensor set; two families may name the same one.
CREATE TABLE layout (
    layout_id     INTEGER PRIMARY KEY,
    study_id      INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    family        TEXT    NOT NULL,                -- 'even', 'distal', 'both', 'explicit'
    start         TEXT    NOT NULL CHECK (start IN ('', 'proximal', 'distal')),  -- of Even: where counting starts
    sensor_count  INTEGER NOT NULL CHECK (sensor_count > 0),
    label         TEXT    NOT NULL,                -- for people: 'Even from the proximal end, 3 sensors'
    sensor_set_id INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,
    UNIQUE (study_id, label)
) STRICT;

-- What has been done; a row is done in the same transaction that writes its results.
CREATE TABLE work_unit (
    study_id       INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    unit_index     INTEGER NOT NULL,
    stage          TEXT    NOT NULL CHECK (stage IN ('single_sensor', 'fusion')),
    scenario_id    INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,
    noise_level_id INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,
    done           INTEGER NOT NULL CHECK (done IN (0, 1)),
    PRIMARY KEY (study_id, unit_index)
) STRICT, WITHOUT ROWID;

-- One row in the file of a shard, none elsewhere. Such a file describes every study in full, but has the results of
-- the shard's own units only; `capstan study merge` joins the shards.
CREATE TABLE shard (
    shard  INTEGER PRIMARY KEY CHECK (shard > 0),  -- from 1
    shards INTEGER NOT NULL CHECK (shards >= shard)
) STRICT;

CREATE TABLE single_sensor (
    scenario_id       INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,
    noise_level_id    INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,
    knowledge         TEXT    NOT NULL CHECK (knowledge IN ('direction_known', 'direction_unknown')),
    sensor_node       INTEGER NOT NULL CHECK (sensor_node > 0),
    mean_abs_error_N  REAL    NOT NULL,            -- over nodes and repetitions
    standard_error_N  REAL    NOT NULL,
    unverified_share  REAL    NOT NULL,            -- no motion pattern verifies
    ambiguous_share   REAL    NOT NULL,            -- more than one verifies
    at_rest_share     REAL    NOT NULL,            -- the sensor's node rests in the estimate: its reading is unused
    PRIMARY KEY (scenario_id, noise_level_id, knowledge, sensor_node)
) STRICT, WITHOUT ROWID;

CREATE TABLE single_sensor_node (
    scenario_id       INTEGER NOT NULL,
    noise_level_id    INTEGER NOT NULL,
    knowledge         TEXT    NOT NULL,
    sensor_node       INTEGER NOT NULL,
    node              INTEGER NOT NULL CHECK (node > 0),
    mean_abs_error_N  REAL    NOT NULL,            -- e_ij of the paper, i = sensor_node, j = node
    mean_tension_N    REAL    NOT NULL,
    tension_q025_N    REAL    NOT NULL,
    tension_q975_N    REAL    NOT NULL,
    PRIMARY KEY (scenario_id, noise_level_id, knowledge, sensor_node, node),
    FOREIGN KEY (scenario_id, noise_level_id, knowledge, sensor_node) REFERENCES single_sensor ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- Weights of the W methods: 1 / (mean single-sensor error), scaled to sum to one over all sensors.
CREATE TABLE sensor_weight (
    scenario_id    INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,
    noise_level_id INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,
    sensor_node    INTEGER NOT NULL CHECK (sensor_node > 0),
    weight_share   REAL    NOT NULL CHECK (weight_share >= 0),
    PRIMARY KEY (scenario_id, noise_level_id, sensor_node)
) STRICT, WITHOUT ROWID;

-- A cell is one scenario, noise level, sensor set and fusion method: errors over nodes and repetitions.
CREATE TABLE cell (
    cell_id            INTEGER PRIMARY KEY,
    scenario_id        INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,
    noise_level_id     INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,
    sensor_set_id      INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,
    method             TEXT    NOT NULL,
    repetitions        INTEGER NOT NULL CHECK (repetitions > 0),
    mean_abs_error_N   REAL    NOT NULL,           -- the paper's metric
    standard_error_N   REAL    NOT NULL,           -- of mean_abs_error_N
    interval_low_N     REAL    NOT NULL,           -- 95% interval of mean_abs_error_N
    interval_high_N    REAL    NOT NULL,
    rms_error_N        REAL    NOT NULL,
    bias_N             REAL    NOT NULL,           -- mean of estimate - truth
    worst_node         INTEGER NOT NULL,           -- the node with the largest mean absolute error
    worst_node_error_N REAL    NOT NULL,
    error_q05_N        REAL    NOT NULL,           -- quantiles over repetitions of the error averaged over nodes
    error_q50_N        REAL    NOT NULL,
    error_q95_N        REAL    NOT NULL,
    unverified_share   REAL    NOT NULL,           -- of the single-sensor estimates that were fused
    ambiguous_share    REAL    NOT NULL,
    UNIQUE (scenario_id, noise_level_id, sensor_set_id, method)
) STRICT;

CREATE TABLE cell_node (
    cell_id          INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,
    node             INTEGER NOT NULL CHECK (node > 0),
    mean_abs_error_N REAL    NOT NULL,
    bias_N           REAL    NOT NULL,
    PRIMARY KEY (cell_id, node)
) STRICT, WITHOUT ROWID;

-- Means over consecutive blocks of repetitions, on draws that all cells of a scenario and noise level share:
-- the difference of two cells, block by block, is a paired difference.
CREATE TABLE cell_block (
    cell_id          INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,
    block            INTEGER NOT NULL,
    mean_abs_error_N REAL    NOT NULL,
    PRIMARY KEY (cell_id, block)
) STRICT, WITHOUT ROWID;

-- Cramer-Rao with the direction known: a line to compare errors with. No row: none of the sensors moves.
CREATE TABLE known_direction_bound (
    scenario_id      INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,
    noise_level_id   INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,
    sensor_set_id    INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,
    mean_abs_error_N REAL    NOT NULL,             -- smallest an unbiased estimate can have, over nodes
    PRIMARY KEY (scenario_id, noise_level_id, sensor_set_id)
) STRICT, WITHOUT ROWID;

-- What to do. One row per noise level and scope.
CREATE TABLE recommendation (
    recommendation_id INTEGER PRIMARY KEY,
    study_id          INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    noise_level_id    INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,
    scope             TEXT    NOT NULL CHECK (scope IN ('regime', 'minimax_regret', 'duty_cycle')),
    regime            TEXT    NOT NULL,            -- '' unless scope is 'regime'
    sensor_set_id     INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,
    method            TEXT    NOT NULL,
    sensor_count      INTEGER NOT NULL,            -- where the gain of one more sensor flattens
    error_N           REAL    NOT NULL,            -- the scope's objective: mean error, largest regret, or duty mean
    interval_low_N    REAL    NOT NULL,
    interval_high_N   REAL    NOT NULL,
    sentence          TEXT    NOT NULL,            -- for a designer to act on
    UNIQUE (study_id, noise_level_id, scope, regime)
) STRICT;

-- The best choice at each count, beside the recommendation.
CREATE TABLE recommendation_count (
    recommendation_id INTEGER NOT NULL REFERENCES recommendation ON DELETE CASCADE,
    sensor_count      INTEGER NOT NULL,
    sensor_set_id     INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,
    method            TEXT    NOT NULL,
    error_N           REAL    NOT NULL,
    interval_low_N    REAL    NOT NULL,
    interval_high_N   REAL    NOT NULL,
    PRIMARY KEY (recommendation_id, sensor_count)
) STRICT, WITHOUT ROWID;

-- The indifferent set: what the draws cannot tell from the recommendation, at its count.
CREATE TABLE recommendation_alternative (
    recommendation_id INTEGER NOT NULL REFERENCES recommendation ON DELETE CASCADE,
    sensor_set_id     INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,
    method            TEXT    NOT NULL,
    difference_N      REAL    NOT NULL,            -- alternative - recommended, paired
    interval_low_N    REAL    NOT NULL,            -- simultaneous 95% interval
    interval_high_N   REAL    NOT NULL,
    PRIMARY KEY (recommendation_id, sensor_set_id, method)
) STRICT, WITHOUT ROWID;

-- The paper's numbers beside ours; only studies that hold what the paper's table needs have rows.
CREATE TABLE paper_comparison (
    study_id         INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,
    row_index        INTEGER NOT NULL,
    quantity         TEXT    NOT NULL,
    paper_N          REAL,                         -- NULL: the paper gives no number
    ours_N           REAL    NOT NULL,
    standard_error_N REAL    NOT NULL,
    relation         TEXT    NOT NULL CHECK (relation IN ('=', '<')),  -- '<': the paper gives a bound
    reason           TEXT    NOT NULL,             -- why the two differ, or that they agree
    PRIMARY KEY (study_id, row_index)
) STRICT, WITHOUT ROWID;

-- What `capstan diagnose` found in one recording.
CREATE TABLE diagnosis (
    diagnosis_id        INTEGER PRIMARY KEY,
    recording           TEXT    NOT NULL,          -- its name, as in the sidecar
    log_file            TEXT    NOT NULL,          -- as it was named to the command; '' where it had no file
    log_sha256          TEXT    NOT NULL CHECK (length(log_sha256) IN (0, 64)),  -- of the log's bytes; '': not known
    program_version     TEXT    NOT NULL,
    runs                TEXT    NOT NULL CHECK (json_valid(runs)),  -- that were diagnosed: '[1,2]'
    verdict             TEXT    NOT NULL,          -- an effect, two as 'a + b', 'none' or 'unknown'
    confidence_share    REAL    NOT NULL CHECK (confidence_share BETWEEN 0 AND 1),  -- probability of the first effect
    component           TEXT    NOT NULL,          -- what the cause sits in: 'cable_a', 'motor', ...; '': nothing
    cable_end           TEXT    NOT NULL,          -- which end of it; '': neither, or not known
    position_m          REAL,                      -- along the cable from the motor; NULL: not a place on a cable
    worst_run           INTEGER NOT NULL,          -- where the gap is largest against noise
    worst_channel       TEXT    NOT NULL,
    friction_ratio      REAL    NOT NULL,          -- nominal numbers as fitted with the causes, of those stated
    stiffness_ratio     REAL    NOT NULL,
    pretension_ratio    REAL    NOT NULL,
    misfit_before_ratio REAL    NOT NULL,          -- mean square residual over that of noise and model floor
    misfit_after_ratio  REAL    NOT NULL,
    independent_samples_count REAL NOT NULL,       -- instants that tell something new
    sentence            TEXT    NOT NULL,          -- the verdict in words
    gap_sentence        TEXT    NOT NULL           -- where the gap is denser than elsewhere, in words
) STRICT;

-- How probable each effect is, `none` and `unknown` among them; sums to 1 in a diagnosis.
CREATE TABLE diagnosis_effect (
    diagnosis_id      INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    place             INTEGER NOT NULL CHECK (place > 0),  -- 1: the most probable
    effect            TEXT    NOT NULL,
    probability_share REAL    NOT NULL CHECK (probability_share BETWEEN 0 AND 1),
    PRIMARY KEY (diagnosis_id, place)
) STRICT, WITHOUT ROWID;

-- The causes that the verdict names, none to two.
CREATE TABLE diagnosis_cause (
    diagnosis_id INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    cause_index  INTEGER NOT NULL,
    effect       TEXT    NOT NULL,
    variant      TEXT    NOT NULL,                 -- '' where the effect has one form only
    component    TEXT    NOT NULL,
    cable_end    TEXT    NOT NULL,
    position_m   REAL,                             -- along the cable from the motor; NULL: not a place on a cable
    PRIMARY KEY (diagnosis_id, cause_index)
) STRICT, WITHOUT ROWID;

-- How severe a cause is: its numbers, as they were fitted.
CREATE TABLE diagnosis_number (
    diagnosis_id  INTEGER NOT NULL,
    cause_index   INTEGER NOT NULL,
    name          TEXT    NOT NULL,
    value_in_unit REAL    NOT NULL,
    unit          TEXT    NOT NULL,                -- '': a ratio
    PRIMARY KEY (diagnosis_id, cause_index, name),
    FOREIGN KEY (diagnosis_id, cause_index) REFERENCES diagnosis_cause ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- Every hypothesis that got a full fit: first two causes together, then one or none; each best first.
CREATE TABLE diagnosis_candidate (
    diagnosis_id       INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    candidate_index    INTEGER NOT NULL,
    effects            TEXT    NOT NULL CHECK (json_valid(effects)),   -- '["backlash"]'; '["none"]': nothing
    variants           TEXT    NOT NULL CHECK (json_valid(variants)),  -- of each effect
    open_numbers       INTEGER NOT NULL,           -- that the fit chose, beyond the nominal ones
    misfit_ratio       REAL    NOT NULL,           -- mean square residual over that of noise and model floor
    nominal_price_log  REAL    NOT NULL,           -- what the nominal numbers' going far costs, in evidence
    -- How much each cause changes the channel where it is clearest, over noise and model floor: '[3.1]'.
    visibility_ratios  TEXT    NOT NULL CHECK (json_valid(visibility_ratios)),
    evidence_log       REAL    NOT NULL,           -- natural logarithm, up to a constant of the diagnosis
    PRIMARY KEY (diagnosis_id, candidate_index)
) STRICT, WITHOUT ROWID;

-- RMS of measured less modelled in each channel that no run drives.
CREATE TABLE diagnosis_channel (
    diagnosis_id          INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    channel_index         INTEGER NOT NULL,
    channel               TEXT    NOT NULL,
    unit                  TEXT    NOT NULL,
    noise_in_unit         REAL    NOT NULL,        -- of one sample
    rms_before_in_unit    REAL    NOT NULL,        -- nominal model
    rms_after_in_unit     REAL    NOT NULL,        -- with the causes
    rms_held_out_in_unit  REAL    NOT NULL,        -- each run with numbers fitted to the others
    rms_runner_up_in_unit REAL    NOT NULL,        -- with the best cause that the verdict does not name
    closed_share          REAL,                    -- of the mean square beyond noise, held out; NULL: no gap to close
    closed_low_share      REAL,                    -- its 95% interval
    closed_high_share     REAL,
    PRIMARY KEY (diagnosis_id, channel_index)
) STRICT, WITHOUT ROWID;

-- Where the gap lies: the share of its energy in each part of the recording.
CREATE TABLE diagnosis_gap (
    diagnosis_id  INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,
    part_index    INTEGER NOT NULL,
    divided_by    TEXT    NOT NULL,                -- 'run', 'channel', 'regime', 'speed', ...
    part          TEXT    NOT NULL,
    energy_share  REAL    NOT NULL,
    low_share     REAL    NOT NULL,                -- its 95% interval
    high_share    REAL    NOT NULL,
    samples_share REAL    NOT NULL,                -- of the compared samples: what chance would give
    PRIMARY KEY (diagnosis_id, part_index)
) STRICT, WITHOUT ROWID;

CREATE INDEX scenario_of_study ON scenario (study_id, regime);
CREATE INDEX layout_of_set ON layout (sensor_set_id);
CREATE INDEX cell_of_set ON cell (sensor_set_id);

-- Error by layout and count: averaged over the instants of a regime and, for Even, over both starts.
-- Instants are drawn independently; the two starts share draws, so their standard errors are averaged, not reduced.
CREATE VIEW v_error_by_layout AS
WITH per_instant AS (
    SELECT s.study_id, s.regime, c.scenario_id, c.noise_level_id, l.family, l.sensor_count, c.method,
           avg(c.mean_abs_error_N) AS mean_abs_error_N, avg(c.standard_error_N) AS standard_error_N,
           avg(c.rms_error_N) AS rms_error_N, avg(c.bias_N) AS bias_N, max(c.worst_node_error_N) AS worst_node_error_N,
           avg(c.unverified_share) AS unverified_share, avg(c.ambiguous_share) AS ambiguous_share
    FROM cell c JOIN scenario s USING (scenario_id) JOIN layout l USING (sensor_set_id)
    GROUP BY s.study_id, s.regime, c.scenario_id, c.noise_level_id, l.family, l.sensor_count, c.method)
SELECT p.study_id, t.name AS study, p.regime, p.noise_level_id, n.label AS noise, p.family, p.sensor_count, p.method,
       f.title AS method_title, f.knowledge, count(*) AS instants,
       avg(p.mean_abs_error_N) AS mean_abs_error_N,
       sqrt(sum(p.standard_error_N * p.standard_error_N)) / count(*) AS standard_error_N,
       avg(p.mean_abs_error_N) - 1.959963984540054 * sqrt(sum(p.standard_error_N * p.standard_error_N)) / count(*) AS interval_low_N,
       avg(p.mean_abs_error_N) + 1.959963984540054 * sqrt(sum(p.standard_error_N * p.standard_error_N)) / count(*) AS interval_high_N,
       avg(p.rms_error_N) AS rms_error_N, avg(p.bias_N) AS bias_N, max(p.worst_node_error_N) AS worst_node_error_N,
       avg(p.unverified_share) AS unverified_share, avg(p.ambiguous_share) AS ambiguous_share
FROM per_instant p JOIN study t USING (study_id) JOIN noise_level n USING (noise_level_id)
JOIN fusion_method f ON f.study_id = p.study_id AND f.method = p.method
GROUP BY p.study_id, p.regime, p.noise_level_id, p.family, p.sensor_count, p.method;

-- The best method per regime, noise level, layout family and count, of those that need not know the direction.
CREATE VIEW v_best_method AS
SELECT study_id, study, regime, noise_level_id, noise, family, sensor_count, method, method_title,
       mean_abs_error_N, interval_low_N, interval_high_N
FROM (SELECT *, row_number() OVER (PARTITION BY study_id, regime, noise_level_id, family, sensor_count
                                   ORDER BY mean_abs_error_N, method) AS place
      FROM v_error_by_layout WHERE knowledge <> 'direction_known')
WHERE place = 1;

-- e_ij: the error at node j of the estimate from the sensor at node i, averaged over the instants of a regime.
CREATE VIEW v_single_sensor_matrix AS
SELECT s.study_id, t.name AS study, s.regime, e.noise_level_id, n.label AS noise, e.knowledge, e.sensor_node, e.node,
       avg(e.mean_abs_error_N) AS mean_abs_error_N
FROM single_sensor_node e JOIN scenario s USING (scenario_id) JOIN study t USING (study_id)
JOIN noise_level n USING (noise_level_id)
GROUP BY s.study_id, s.regime, e.noise_level_id, e.knowledge, e.sensor_node, e.node;

-- How far each study has come.
CREATE VIEW v_progress AS
SELECT t.study_id, t.name AS study, t.status, coalesce(sum(w.done), 0) AS units_done, count(w.unit_index) AS units
FROM study t LEFT JOIN work_unit w USING (study_id) GROUP BY t.study_id;

-- The recommendations in words, with layout and method names.
CREATE VIEW v_recommendation AS
SELECT r.recommendation_id, r.study_id, t.name AS study, n.label AS noise, r.scope, r.regime,
       (SELECT min(l.label) FROM layout l WHERE l.sensor_set_id = r.sensor_set_id) AS layout,
       ss.nodes, r.sensor_count, f.title AS method_title, r.error_N, r.interval_low_N, r.interval_high_N, r.sentence
FROM recommendation r JOIN study t USING (study_id) JOIN noise_level n USING (noise_level_id)
JOIN sensor_set ss USING (sensor_set_id) JOIN fusion_method f ON f.study_id = r.study_id AND f.method = r.method;

-- The diagnoses, each with the channel that it is judged by: the load's torque, else its first.
CREATE VIEW v_diagnosis AS
SELECT d.diagnosis_id, d.recording, d.verdict, d.confidence_share, d.component, d.cable_end, d.position_m,
       c.channel, c.unit, c.rms_before_in_unit, c.rms_after_in_unit, c.rms_held_out_in_unit,
       c.closed_share, c.closed_low_share, c.closed_high_share, d.sentence
FROM diagnosis d LEFT JOIN diagnosis_channel c ON c.diagnosis_id = d.diagnosis_id AND c.channel_index = (
    SELECT channel_index FROM diagnosis_channel j WHERE j.diagnosis_id = d.diagnosis_id
    ORDER BY j.channel <> 'load_torque', j.channel_index LIMIT 1);
