-- The results database of capstan, version 7. One home: everything that stores or reads goes through this text.
--
-- Rules: every physical column ends in its unit (N, m, rad, s); a fraction or a ratio has no unit and says so in its
-- name; _in_unit is in the unit that the row's column 'unit' names; nodes are numbered from 1 (proximal, motor) to
-- segments + 1 (distal, load); there is no clock in any table but history, and no fact about a machine in any but
-- computed_with, so the same program, configuration and seed give the same bits.

-- One question asked of the engine many times: a configuration, as it ran.
CREATE TABLE study (
    study_id        INTEGER PRIMARY KEY,           -- 1, 2, ... in the order they were begun
    name            TEXT    NOT NULL,              -- as in the configuration
    config_toml     TEXT    NOT NULL,              -- every key written out, defaults included
    program_version TEXT    NOT NULL,              -- of the capstan that began it
    seed            INTEGER NOT NULL,              -- 64 bits, as SQLite keeps them: signed
    repetitions     INTEGER NOT NULL CHECK (repetitions > 0),  -- draws of noise per scenario and noise level
    segments        INTEGER NOT NULL CHECK (segments > 0),  -- of the cable
    status          TEXT    NOT NULL CHECK (status IN ('running', 'complete'))  -- running: begun, not ended; resume it
) STRICT;

-- What was done to a study, when and by which command. The one table with a clock: no answer is made of it.
CREATE TABLE history (
    event_id INTEGER PRIMARY KEY,                  -- 1, 2, ... as it happened
    study_id INTEGER NOT NULL,                     -- its study; kept when that is removed, so that no number comes twice
    study    TEXT    NOT NULL,                     -- its name
    event    TEXT    NOT NULL,                     -- 'begun', 'completed', 'deleted', 'restored' or 'removed'
    at_utc   TEXT    NOT NULL,                     -- '2026-01-31T12:00:00Z'
    command  TEXT    NOT NULL                      -- as it was given; '': by a program that uses the library
) STRICT;

-- What people say about a study. A study without a row has no note and is not deleted.
CREATE TABLE study_mark (
    study_id   INTEGER PRIMARY KEY REFERENCES study ON DELETE CASCADE,  -- its study
    note       TEXT    NOT NULL DEFAULT '',        -- free text
    tags       TEXT    NOT NULL DEFAULT '',        -- words, with single blanks between them
    is_deleted INTEGER NOT NULL DEFAULT 0 CHECK (is_deleted IN (0, 1))  -- 1: in the trash, to be restored or removed
) STRICT;

-- The cable, segment by segment from the motor.
CREATE TABLE cable_segment (
    study_id       INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    segment        INTEGER NOT NULL CHECK (segment > 0),  -- from 1
    start_m        REAL    NOT NULL,               -- arc length from the proximal end
    length_m       REAL    NOT NULL CHECK (length_m > 0),  -- along the arc
    bend_radius_m  REAL,                           -- NULL: straight
    wrap_angle_rad REAL    NOT NULL,               -- by which the segment turns; what friction acts on
    PRIMARY KEY (study_id, segment)
) STRICT, WITHOUT ROWID;

-- The regimes of motion that a study looks at.
CREATE TABLE regime (
    study_id    INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    -- Which part of the cable moves.
    regime      TEXT    NOT NULL CHECK (regime IN ('mass', 'partial_proximal', 'partial_distal', 'partial_both')),
    duty_fraction  REAL    NOT NULL CHECK (duty_fraction BETWEEN 0 AND 1),  -- fraction of working time; sums to 1 in a study
    PRIMARY KEY (study_id, regime)
) STRICT, WITHOUT ROWID;

-- A scenario is one instant of the true motion in one regime.
CREATE TABLE scenario (
    scenario_id              INTEGER PRIMARY KEY,  -- its number in the file
    study_id                 INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    scenario_index           INTEGER NOT NULL,     -- 0, 1, ... in the order of the configuration
    regime                   TEXT    NOT NULL,     -- of the motion at that instant
    sample                   INTEGER NOT NULL,     -- the instant, as a sample number of the motion
    time_s                   REAL    NOT NULL,     -- since the motion began
    motion                   TEXT    NOT NULL CHECK (motion IN ('forward', 'backward')),  -- of the proximal end
    proximal_displacement_m  REAL    NOT NULL,     -- of the motor end, positive towards the load
    proximal_increment_m     REAL    NOT NULL,     -- since the sample before
    UNIQUE (study_id, scenario_index),
    FOREIGN KEY (study_id, regime) REFERENCES regime (study_id, regime) ON DELETE CASCADE
) STRICT;

-- The true state of a scenario at every node, and the one a sample before.
CREATE TABLE scenario_node (
    scenario_id             INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,  -- its scenario
    node                    INTEGER NOT NULL CHECK (node > 0),  -- from 1 at the motor
    arc_length_m            REAL    NOT NULL,      -- from the motor
    true_tension_N          REAL    NOT NULL,      -- what an estimate should be
    true_displacement_m     REAL    NOT NULL,      -- positive towards the load
    previous_tension_N      REAL    NOT NULL,      -- one sample earlier: what every estimate starts from
    previous_displacement_m REAL    NOT NULL,      -- one sample earlier
    direction               INTEGER NOT NULL CHECK (direction IN (-1, 0, 1)),  -- of the node's true motion
    PRIMARY KEY (scenario_id, node)
) STRICT, WITHOUT ROWID;

-- reading = tension * (1 + multiplicative_ratio * e1) + additive_N * e2 + bias_N * e3, e1, e2, e3 standard normal;
-- e3 is drawn once per sensor and repetition, and is the same at every instant. The reading is then rounded to integer
-- steps of quantisation_N and ends at range_N.
CREATE TABLE noise_level (
    noise_level_id       INTEGER PRIMARY KEY,      -- its number in the file
    study_id             INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    noise_index          INTEGER NOT NULL,         -- 0, 1, ... in the order of the configuration
    label                TEXT    NOT NULL,         -- for people: '10 %', '0.2 N'
    -- Standard deviation of the part that grows with the tension.
    multiplicative_ratio REAL    NOT NULL CHECK (multiplicative_ratio >= 0),
    additive_N           REAL    NOT NULL CHECK (additive_N >= 0),  -- standard deviation at any tension
    bias_N               REAL    NOT NULL CHECK (bias_N >= 0),  -- standard deviation of the offset that a sensor keeps
    quantisation_N       REAL    CHECK (quantisation_N >= 0),  -- 0: none; NULL: stored before version 3, see config_toml
    range_N              REAL    CHECK (range_N > 0),          -- the largest reading; NULL as above
    UNIQUE (study_id, noise_index)
) STRICT;

-- The ways to fuse the readings of several sensors.
CREATE TABLE fusion_method (
    study_id     INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    method       TEXT    NOT NULL,                 -- 'mean', 'w_mean_r', 'posterior_mean', ...
    method_index INTEGER NOT NULL,                 -- 0, 1, ... in the order of tables
    title        TEXT    NOT NULL,                 -- as figures write it: 'W Mean-R'
    -- What the method must be told, or uses.
    knowledge    TEXT    NOT NULL CHECK (knowledge IN ('direction_known', 'direction_unknown', 'feasible_curve')),
    meaning      TEXT    NOT NULL,                 -- in words
    PRIMARY KEY (study_id, method)
) STRICT, WITHOUT ROWID;

-- Different sets of nodes that carry a sensor; each is worked on once.
CREATE TABLE sensor_set (
    sensor_set_id INTEGER PRIMARY KEY,             -- its number in the file
    study_id      INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    set_index     INTEGER NOT NULL,                -- 0, 1, ... in the order of first use
    sensor_count  INTEGER NOT NULL CHECK (sensor_count > 0),  -- how many nodes carry one
    nodes         TEXT    NOT NULL CHECK (json_valid(nodes)),  -- '[1,6,11]'
    UNIQUE (study_id, set_index),
    UNIQUE (study_id, nodes)
) STRICT;

-- A layout names a sensor set; two families may name the same one.
CREATE TABLE layout (
    layout_id     INTEGER PRIMARY KEY,             -- its number in the file
    study_id      INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    family        TEXT    NOT NULL,                -- 'even', 'distal', 'both', 'explicit'
    start         TEXT    NOT NULL CHECK (start IN ('', 'proximal', 'distal')),  -- of Even: where counting starts
    sensor_count  INTEGER NOT NULL CHECK (sensor_count > 0),  -- how many sensors
    label         TEXT    NOT NULL,                -- for people: 'Even from the proximal end, 3 sensors'
    sensor_set_id INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,  -- the nodes that it means
    UNIQUE (study_id, label)
) STRICT;

-- What has been done; a row is done in the same transaction that writes its results.
CREATE TABLE work_unit (
    study_id       INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    unit_index     INTEGER NOT NULL,               -- 0, 1, ... in the order of work
    stage          TEXT    NOT NULL CHECK (stage IN ('single_sensor', 'fusion')),  -- what is computed
    scenario_id    INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,  -- of which scenario
    noise_level_id INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,  -- at which noise level
    done           INTEGER NOT NULL CHECK (done IN (0, 1)),  -- 1: its results are stored
    PRIMARY KEY (study_id, unit_index)
) STRICT, WITHOUT ROWID;

-- One row in the file of a shard, none elsewhere. Such a file describes every study in full, but has the results of
-- the shard's own units only; `capstan study merge` joins the shards.
CREATE TABLE shard (
    shard  INTEGER PRIMARY KEY CHECK (shard > 0),  -- from 1
    shards INTEGER NOT NULL CHECK (shards >= shard)  -- how many there are
) STRICT;

-- How good the estimate from one sensor alone is.
CREATE TABLE single_sensor (
    scenario_id       INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,  -- its scenario
    noise_level_id    INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,  -- its noise level
    -- Whether the direction of motion is known.
    knowledge         TEXT    NOT NULL CHECK (knowledge IN ('direction_known', 'direction_unknown')),
    sensor_node       INTEGER NOT NULL CHECK (sensor_node > 0),  -- where the sensor is, from 1
    mean_abs_error_N  REAL    NOT NULL,            -- over nodes and repetitions
    standard_error_N  REAL    NOT NULL,            -- of mean_abs_error_N
    unverified_fraction  REAL    NOT NULL,            -- no motion pattern verifies
    ambiguous_fraction   REAL    NOT NULL,            -- more than one verifies
    at_rest_fraction     REAL    NOT NULL,            -- the sensor's node rests in the estimate: its reading is unused
    PRIMARY KEY (scenario_id, noise_level_id, knowledge, sensor_node)
) STRICT, WITHOUT ROWID;

-- The same at every node: the matrix e_ij.
CREATE TABLE single_sensor_node (
    scenario_id       INTEGER NOT NULL,            -- as in single_sensor
    noise_level_id    INTEGER NOT NULL,            -- as in single_sensor
    knowledge         TEXT    NOT NULL,            -- as in single_sensor
    sensor_node       INTEGER NOT NULL,            -- as in single_sensor
    node              INTEGER NOT NULL CHECK (node > 0),  -- where the error is, from 1
    mean_abs_error_N  REAL    NOT NULL,            -- e_ij of the paper, i = sensor_node, j = node
    mean_tension_N    REAL    NOT NULL,            -- of the estimate, over repetitions
    tension_q025_N    REAL    NOT NULL,            -- 2.5% quantile of the estimate
    tension_q975_N    REAL    NOT NULL,            -- 97.5% quantile of the estimate
    PRIMARY KEY (scenario_id, noise_level_id, knowledge, sensor_node, node),
    FOREIGN KEY (scenario_id, noise_level_id, knowledge, sensor_node) REFERENCES single_sensor ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- Weights of the W methods: 1 / (mean single-sensor error), scaled to sum to one over all sensors.
CREATE TABLE sensor_weight (
    scenario_id    INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,  -- its scenario
    noise_level_id INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,  -- its noise level
    sensor_node    INTEGER NOT NULL CHECK (sensor_node > 0),  -- where the sensor is, from 1
    weight_fraction   REAL    NOT NULL CHECK (weight_fraction >= 0),  -- sums to 1 over all sensors
    PRIMARY KEY (scenario_id, noise_level_id, sensor_node)
) STRICT, WITHOUT ROWID;

-- A cell is one scenario, noise level, sensor set and fusion method: errors over nodes and repetitions.
CREATE TABLE cell (
    cell_id            INTEGER PRIMARY KEY,        -- the study, then its number within: 2000000017 is cell 17 of study 2
    scenario_id        INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,  -- its scenario
    noise_level_id     INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,  -- its noise level
    sensor_set_id      INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,  -- its sensors
    method             TEXT    NOT NULL,           -- its fusion method
    repetitions        INTEGER NOT NULL CHECK (repetitions > 0),  -- draws that it sums up
    mean_abs_error_N   REAL    NOT NULL,           -- the paper's metric
    standard_error_N   REAL    NOT NULL,           -- of mean_abs_error_N
    interval_low_N     REAL    NOT NULL,           -- 95% interval of mean_abs_error_N
    interval_high_N    REAL    NOT NULL,           -- upper end of that interval
    rms_error_N        REAL    NOT NULL,           -- root of the mean square error
    bias_N             REAL    NOT NULL,           -- mean of estimate - truth
    worst_node         INTEGER NOT NULL,           -- the node with the largest mean absolute error
    worst_node_error_N REAL    NOT NULL,           -- the mean absolute error there
    error_q05_N        REAL    NOT NULL,           -- quantiles over repetitions of the error averaged over nodes
    error_q50_N        REAL    NOT NULL,           -- median
    error_q95_N        REAL    NOT NULL,           -- 95% quantile
    unverified_fraction   REAL    NOT NULL,           -- of the single-sensor estimates that were fused
    ambiguous_fraction    REAL    NOT NULL,
    UNIQUE (scenario_id, noise_level_id, sensor_set_id, method)
) STRICT;

-- Errors of a cell at every node.
CREATE TABLE cell_node (
    cell_id          INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,  -- its cell
    node             INTEGER NOT NULL CHECK (node > 0),  -- from 1
    mean_abs_error_N REAL    NOT NULL,             -- over repetitions
    bias_N           REAL    NOT NULL,             -- mean of estimate - truth
    PRIMARY KEY (cell_id, node)
) STRICT, WITHOUT ROWID;

-- Means over consecutive blocks of repetitions, on draws that all cells of a scenario and noise level share:
-- the difference of two cells, block by block, is a paired difference.
CREATE TABLE cell_block (
    cell_id          INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,  -- its cell
    block            INTEGER NOT NULL,             -- from 0; the same repetitions in every cell
    mean_abs_error_N REAL    NOT NULL,
    PRIMARY KEY (cell_id, block)
) STRICT, WITHOUT ROWID;

-- Cramer-Rao with the direction known: a line to compare errors with. No row: none of the sensors moves.
CREATE TABLE known_direction_bound (
    scenario_id      INTEGER NOT NULL REFERENCES scenario ON DELETE CASCADE,  -- its scenario
    noise_level_id   INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,  -- its noise level
    sensor_set_id    INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,  -- its sensors
    mean_abs_error_N REAL    NOT NULL,             -- smallest an unbiased estimate can have, over nodes
    PRIMARY KEY (scenario_id, noise_level_id, sensor_set_id)
) STRICT, WITHOUT ROWID;

-- The error by layout and count of a complete study, as v_error_by_layout has it: worked out once, when the study is
-- completed, since such a study does not change. So a question is answered at once among ten million cells.
CREATE TABLE layout_error (
    study_id           INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    regime             TEXT    NOT NULL,           -- of the instants
    noise_level_id     INTEGER NOT NULL,           -- its noise level
    family             TEXT    NOT NULL,           -- of the layouts, as in layout
    sensor_count       INTEGER NOT NULL,           -- how many nodes carry one
    method             TEXT    NOT NULL,           -- how the readings are fused
    instants           INTEGER NOT NULL,           -- scenarios that are averaged
    mean_abs_error_N   REAL    NOT NULL,           -- over instants and variants of the layout
    standard_error_N   REAL    NOT NULL,           -- of mean_abs_error_N
    rms_error_N        REAL    NOT NULL,           -- root of the mean square error
    bias_N             REAL    NOT NULL,           -- mean of estimate - truth
    worst_node_error_N REAL    NOT NULL,           -- the largest of any instant
    unverified_fraction   REAL    NOT NULL,           -- of the single-sensor estimates that were fused
    ambiguous_fraction    REAL    NOT NULL,           -- likewise
    best               INTEGER NOT NULL CHECK (best IN (0, 1)),  -- 1: of its layouts, the method of v_best_method
    PRIMARY KEY (study_id, regime, noise_level_id, family, sensor_count, method)
) STRICT, WITHOUT ROWID;

-- e_ij of a complete study, as v_single_sensor_matrix has it: kept likewise.
CREATE TABLE sensor_matrix (
    study_id         INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    regime           TEXT    NOT NULL,             -- of the instants
    noise_level_id   INTEGER NOT NULL,             -- its noise level
    knowledge        TEXT    NOT NULL,             -- whether the direction of motion is known
    sensor_node      INTEGER NOT NULL,             -- i, where the sensor is
    node             INTEGER NOT NULL,             -- j, where the error is
    mean_abs_error_N REAL    NOT NULL,             -- e_ij
    PRIMARY KEY (study_id, regime, noise_level_id, knowledge, sensor_node, node)
) STRICT, WITHOUT ROWID;

-- What to do. One row per noise level and scope.
CREATE TABLE recommendation (
    recommendation_id INTEGER PRIMARY KEY,         -- the study, then its number within, as cell_id
    study_id          INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    noise_level_id    INTEGER NOT NULL REFERENCES noise_level ON DELETE CASCADE,  -- at which noise
    -- What is made small: the error in a regime, the largest regret over regimes, the mean over the duty cycle.
    scope             TEXT    NOT NULL CHECK (scope IN ('regime', 'minimax_regret', 'duty_cycle')),
    regime            TEXT    NOT NULL,            -- '' unless scope is 'regime'
    sensor_set_id     INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,  -- where to put sensors
    method            TEXT    NOT NULL,            -- how to fuse them
    sensor_count      INTEGER NOT NULL,            -- where the gain of one more sensor flattens
    error_N           REAL    NOT NULL,            -- the scope's objective: mean error, largest regret, or duty mean
    interval_low_N    REAL    NOT NULL,            -- 95% interval of error_N
    interval_high_N   REAL    NOT NULL,            -- upper end of that interval
    sentence          TEXT    NOT NULL,            -- for a designer to act on
    UNIQUE (study_id, noise_level_id, scope, regime)
) STRICT;

-- The best choice at each count, beside the recommendation.
CREATE TABLE recommendation_count (
    recommendation_id INTEGER NOT NULL REFERENCES recommendation ON DELETE CASCADE,  -- its recommendation
    sensor_count      INTEGER NOT NULL,            -- at this count
    sensor_set_id     INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,  -- where to put sensors
    method            TEXT    NOT NULL,            -- how to fuse them
    error_N           REAL    NOT NULL,            -- the objective, as in recommendation
    interval_low_N    REAL    NOT NULL,            -- 95% interval of error_N
    interval_high_N   REAL    NOT NULL,            -- upper end of that interval
    PRIMARY KEY (recommendation_id, sensor_count)
) STRICT, WITHOUT ROWID;

-- The indifferent set: what the draws cannot tell from the recommendation, at its count.
CREATE TABLE recommendation_alternative (
    recommendation_id INTEGER NOT NULL REFERENCES recommendation ON DELETE CASCADE,  -- its recommendation
    sensor_set_id     INTEGER NOT NULL REFERENCES sensor_set ON DELETE CASCADE,  -- other sensors
    method            TEXT    NOT NULL,            -- or another method
    difference_N      REAL    NOT NULL,            -- alternative - recommended, paired
    interval_low_N    REAL    NOT NULL,            -- simultaneous 95% interval
    interval_high_N   REAL    NOT NULL,            -- upper end of that interval
    PRIMARY KEY (recommendation_id, sensor_set_id, method)
) STRICT, WITHOUT ROWID;

-- The paper's numbers beside ours; only studies that hold what the paper's table needs have rows.
CREATE TABLE paper_comparison (
    study_id         INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    row_index        INTEGER NOT NULL,             -- 0, 1, ... in the order of the table
    quantity         TEXT    NOT NULL,             -- what is compared
    paper_N          REAL,                         -- NULL: the paper gives no number
    ours_N           REAL    NOT NULL,             -- as this study has it
    standard_error_N REAL    NOT NULL,             -- of ours_N
    relation         TEXT    NOT NULL CHECK (relation IN ('=', '<')),  -- '<': the paper gives a bound
    reason           TEXT    NOT NULL,             -- why the two differ, or that they agree
    PRIMARY KEY (study_id, row_index)
) STRICT, WITHOUT ROWID;

-- A study with [uncertainty] compares sets of sensors in worlds. The sets that could be bought; 0 has no sensor.
CREATE TABLE world_candidate (
    study_id        INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    candidate_index INTEGER NOT NULL CHECK (candidate_index >= 0),  -- 0, 1, ... by price; then as a greedy search adds them
    sensors         TEXT    NOT NULL CHECK (json_valid(sensors)),  -- '[{"kind":"tension","place_m":0.6}]'
    words           TEXT    NOT NULL,              -- for people: 'tension at 0.6 m'
    families        TEXT    NOT NULL,              -- the named sets that it is: 'even both'; '': none
    sensor_count    INTEGER NOT NULL CHECK (sensor_count >= 0),  -- how many sensors
    price           REAL    NOT NULL,              -- of all of them, in the unit of the configuration
    PRIMARY KEY (study_id, candidate_index)
) STRICT, WITHOUT ROWID;

-- The error of one set of sensors in one world, over its entire motion. All numbers of an answer follow from these.
CREATE TABLE world_error (
    study_id             INTEGER NOT NULL,         -- as in world_candidate
    candidate_index      INTEGER NOT NULL,         -- as in world_candidate
    condition            TEXT    NOT NULL,         -- 'as_stated', 'friction_known', 'half_width', 'finer_grid', ...
    world                INTEGER NOT NULL,         -- from 0; the same number is the same world for all sets
    mean_abs_error_N     REAL    NOT NULL,         -- over samples and nodes
    load_end_error_N     REAL    NOT NULL,         -- at the distal node, over samples
    worst_place_error_N  REAL    NOT NULL,         -- at the node where it is largest, over samples
    mean_square_error_N2 REAL    NOT NULL,         -- over samples and nodes [N2]
    covered_fraction     REAL    NOT NULL,         -- of the true tensions within the estimate's 95% band
    PRIMARY KEY (study_id, condition, candidate_index, world),
    FOREIGN KEY (study_id, candidate_index) REFERENCES world_candidate ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- What a study with [uncertainty] recommends; its errors are from worlds that had no part in choosing the set of a price.
CREATE TABLE world_recommendation (
    study_id          INTEGER PRIMARY KEY REFERENCES study ON DELETE CASCADE,  -- its study
    objective         TEXT    NOT NULL,            -- 'all_nodes', 'load_end', 'worst_node' or 'quantile_95'
    candidate_index   INTEGER NOT NULL,            -- the set, as in world_candidate
    estimator         TEXT    NOT NULL,            -- of the tensions
    expected_error_N  REAL    NOT NULL,            -- the objective
    error_95_N        REAL    NOT NULL,            -- that 95% of the worlds stay below
    interval_low_N    REAL    NOT NULL,            -- Monte-Carlo interval of expected_error_N, 95%
    interval_high_N   REAL    NOT NULL,            -- upper end of that interval
    no_sensor_error_N REAL    NOT NULL,            -- the same without any sensor
    beats_no_sensor   INTEGER NOT NULL CHECK (beats_no_sensor IN (0, 1)),  -- 1: better in a paired t test at 5%
    sentence          TEXT    NOT NULL             -- for a designer to act on
) STRICT;

-- What `capstan diagnose` found in one recording.
CREATE TABLE diagnosis (
    diagnosis_id        INTEGER PRIMARY KEY,       -- 1, 2, ... in the order they were stored
    recording           TEXT    NOT NULL,          -- its name, as in the sidecar
    log_file            TEXT    NOT NULL,          -- as it was named to the command; '' where it had no file
    log_sha256          TEXT    NOT NULL CHECK (length(log_sha256) IN (0, 64)),  -- of the log's bytes; '': not known
    program_version     TEXT    NOT NULL,          -- of the capstan that made it
    runs                TEXT    NOT NULL CHECK (json_valid(runs)),  -- that were diagnosed: '[1,2]'
    verdict             TEXT    NOT NULL,          -- an effect, two as 'a + b', 'none' or 'unknown'
    confidence_fraction    REAL    NOT NULL CHECK (confidence_fraction BETWEEN 0 AND 1),  -- probability of the first effect
    component           TEXT    NOT NULL,          -- what the cause sits in: 'cable_a', 'motor', ...; '': nothing
    cable_end           TEXT    NOT NULL,          -- which end of it; '': neither, or not known
    position_m          REAL,                      -- along the cable from the motor; NULL: not a place on a cable
    worst_run           INTEGER NOT NULL,          -- where the gap is largest against noise
    worst_channel       TEXT    NOT NULL,          -- with worst_run
    friction_ratio      REAL    NOT NULL,          -- nominal numbers as fitted with the causes, of those stated
    stiffness_ratio     REAL    NOT NULL,          -- likewise
    pretension_ratio    REAL    NOT NULL,          -- likewise
    friction_low_ratio    REAL,                    -- 95% interval of friction_ratio; NULL: made before version 3
    friction_high_ratio   REAL,                    -- upper end of that interval
    stiffness_low_ratio   REAL,                    -- likewise
    stiffness_high_ratio  REAL,                    -- upper end of that interval
    pretension_low_ratio  REAL,                    -- likewise
    pretension_high_ratio REAL,                    -- upper end of that interval
    misfit_before_ratio REAL    NOT NULL,          -- mean square residual over that of noise and model floor
    misfit_after_ratio  REAL    NOT NULL,          -- the same with the causes
    independent_samples_count REAL NOT NULL,       -- instants that tell something new
    sentence            TEXT    NOT NULL,          -- the verdict in words
    gap_sentence        TEXT    NOT NULL           -- where the gap is denser than elsewhere, in words
) STRICT;

-- How probable each effect is, `none` and `unknown` among them; sums to 1 in a diagnosis.
CREATE TABLE diagnosis_effect (
    diagnosis_id      INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,  -- its diagnosis
    place             INTEGER NOT NULL CHECK (place > 0),  -- 1: the most probable
    effect            TEXT    NOT NULL,            -- as in the catalogue of effects; 'none', 'unknown'
    probability_fraction REAL    NOT NULL CHECK (probability_fraction BETWEEN 0 AND 1),  -- its share of the probability of the explanations that hold it
    present_fraction  REAL,                        -- probability that the effect is there at all, whatever else is; NULL before version 4
    varies            TEXT    NOT NULL DEFAULT '', -- the condition of the runs that its numbers follow; '': none
    PRIMARY KEY (diagnosis_id, place)
) STRICT, WITHOUT ROWID;

-- The causes that the verdict names.
CREATE TABLE diagnosis_cause (
    diagnosis_id INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,  -- its diagnosis
    cause_index  INTEGER NOT NULL,                 -- 0, 1, ...
    effect       TEXT    NOT NULL,                 -- as in the catalogue of effects
    variant      TEXT    NOT NULL,                 -- '' where the effect has one form only
    component    TEXT    NOT NULL,                 -- what it sits in
    cable_end    TEXT    NOT NULL,                 -- which end of it; '': neither
    position_m   REAL,                             -- along the cable from the motor; NULL: not a place on a cable
    PRIMARY KEY (diagnosis_id, cause_index)
) STRICT, WITHOUT ROWID;

-- How severe a cause is: its numbers, as they were fitted.
CREATE TABLE diagnosis_number (
    diagnosis_id  INTEGER NOT NULL,                -- its diagnosis
    cause_index   INTEGER NOT NULL,                -- its cause
    name          TEXT    NOT NULL,                -- as in the catalogue of effects
    value_in_unit REAL    NOT NULL,                -- as fitted
    unit          TEXT    NOT NULL,                -- '': a ratio
    low_in_unit   REAL,                            -- its 95% interval; NULL: not fitted, or made before version 3
    high_in_unit  REAL,                            -- upper end of that interval
    PRIMARY KEY (diagnosis_id, cause_index, name),
    FOREIGN KEY (diagnosis_id, cause_index) REFERENCES diagnosis_cause ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- Every set of causes that got a full fit, best first.
CREATE TABLE diagnosis_candidate (
    diagnosis_id       INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,  -- its diagnosis
    candidate_index    INTEGER NOT NULL,           -- 0, 1, ...
    effects            TEXT    NOT NULL CHECK (json_valid(effects)),   -- '["backlash"]'; '["none"]': nothing
    variants           TEXT    NOT NULL CHECK (json_valid(variants)),  -- of each effect
    open_numbers       INTEGER NOT NULL,           -- that the fit chose, beyond the nominal ones
    misfit_ratio       REAL    NOT NULL,           -- mean square residual over that of noise and model floor
    nominal_penalty_log  REAL    NOT NULL,           -- what the nominal numbers' going far costs, in evidence
    -- How much each cause changes the channel where it is clearest, over noise and model floor: '[3.1]'.
    visibility_ratios  TEXT    NOT NULL CHECK (json_valid(visibility_ratios)),
    evidence_log       REAL    NOT NULL,           -- natural logarithm, up to a constant of the diagnosis
    PRIMARY KEY (diagnosis_id, candidate_index)
) STRICT, WITHOUT ROWID;

-- RMS of measured less modelled in each channel that no run drives.
CREATE TABLE diagnosis_channel (
    diagnosis_id          INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,  -- its diagnosis
    channel_index         INTEGER NOT NULL,        -- 0, 1, ... in the order of the recording
    channel               TEXT    NOT NULL,        -- as in the sidecar
    unit                  TEXT    NOT NULL,        -- of the channel
    noise_in_unit         REAL    NOT NULL,        -- of one sample
    rms_before_in_unit    REAL    NOT NULL,        -- nominal model
    rms_after_in_unit     REAL    NOT NULL,        -- with the causes
    rms_held_out_in_unit  REAL    NOT NULL,        -- each run with numbers fitted to the others
    rms_runner_up_in_unit REAL    NOT NULL,        -- with the best cause that the verdict does not name
    closed_fraction          REAL,                    -- of the mean square beyond noise, held out; NULL: no gap to close
    closed_low_fraction      REAL,                    -- its 95% interval
    closed_high_fraction     REAL,                    -- upper end of that interval
    PRIMARY KEY (diagnosis_id, channel_index)
) STRICT, WITHOUT ROWID;

-- Where the gap lies: the fraction of its energy in each part of the recording.
CREATE TABLE diagnosis_gap (
    diagnosis_id  INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,  -- its diagnosis
    part_index    INTEGER NOT NULL,                -- 0, 1, ...
    divided_by    TEXT    NOT NULL,                -- 'run', 'channel', 'regime', 'speed', ...
    part          TEXT    NOT NULL,                -- which part: '2', 'mass', 'after reversal'
    energy_fraction  REAL    NOT NULL,                -- of what the nominal model leaves beyond noise
    low_fraction     REAL    NOT NULL,                -- its 95% interval
    high_fraction    REAL    NOT NULL,                -- upper end of that interval
    samples_fraction REAL    NOT NULL,                -- of the compared samples: what chance would give
    PRIMARY KEY (diagnosis_id, part_index)
) STRICT, WITHOUT ROWID;

-- SHA-256 of what is stored of a study, written in the transaction that stores it: `capstan doctor` and a merge work it
-- out again. Nothing but the stored values is in it: no number that depends on the file, on threads or on shards.
CREATE TABLE content_hash (
    study_id   INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    -- 'description', 'unit', 'conclusions', 'study' (of all other rows here), or 'worlds ' and a condition.
    part       TEXT    NOT NULL,
    part_index INTEGER NOT NULL,                   -- of a unit its unit_index, of worlds their number / 64, otherwise 0
    table_name TEXT    NOT NULL,                   -- the table whose rows are hashed; tables without a row are left out
    sha256     TEXT    NOT NULL CHECK (length(sha256) = 64),  -- of worlds the sum over rows, as it does not depend on order
    PRIMARY KEY (study_id, part, part_index, table_name)
) STRICT, WITHOUT ROWID;

-- The same of a diagnosis.
CREATE TABLE diagnosis_hash (
    diagnosis_id INTEGER NOT NULL REFERENCES diagnosis ON DELETE CASCADE,  -- its diagnosis
    table_name   TEXT    NOT NULL,                 -- the table whose rows are hashed
    sha256       TEXT    NOT NULL CHECK (length(sha256) = 64),  -- of its rows
    PRIMARY KEY (diagnosis_id, table_name)
) STRICT, WITHOUT ROWID;

-- What a study was computed with: facts about machines, which no answer is made of and no hash has.
CREATE TABLE computed_with (
    study_id        INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    simd            TEXT    NOT NULL,              -- vector instructions: 'AVX2', ...; others give other last bits
    compiler        TEXT    NOT NULL,              -- of the program: 'g++ 12.2.0'
    program_version TEXT    NOT NULL,              -- of the capstan that computed units or conclusions
    PRIMARY KEY (study_id, simd, compiler, program_version)
) STRICT, WITHOUT ROWID;

CREATE INDEX scenario_of_study ON scenario (study_id, regime);
CREATE INDEX layout_of_set ON layout (sensor_set_id);
CREATE INDEX cell_of_set ON cell (sensor_set_id);
CREATE INDEX best_layout_error ON layout_error (study_id, regime, noise_level_id, family, sensor_count, method,
                                                mean_abs_error_N, standard_error_N) WHERE best = 1;

-- What layout_error will hold of the studies that still run: averaged over the instants of a regime and, for Even, over
-- both starts. Instants are drawn independently; the two starts share draws, so their standard errors are averaged, not
-- reduced. CROSS JOIN begins with the few studies that run, so that no question goes through the cells of all the others.
CREATE VIEW v_running_layout_error AS
-- study_id: its study
-- regime: of the instants
-- noise_level_id: its noise level
-- instants: scenarios that are averaged
-- mean_abs_error_N: over instants and variants of the layout
-- standard_error_N: of mean_abs_error_N
-- bias_N: mean of estimate - truth
-- worst_node_error_N: the largest of any instant
-- best: 1: of its layouts, the method of v_best_method
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

-- Error by layout and count: of a complete study as it is kept, of a running one as it is now. CROSS JOIN gives each row its
-- names as it comes: the first rows of many are there at once.
CREATE VIEW v_error_by_layout AS
-- study_id: its study
-- study: its name
-- regime: of the instants
-- noise_level_id: its noise level
-- noise: its label
-- method_title: as figures write it
-- knowledge: what the method must be told, or uses
-- instants: scenarios that are averaged
-- mean_abs_error_N: over instants and variants of the layout
-- standard_error_N: of mean_abs_error_N
-- interval_low_N: 95% interval of mean_abs_error_N
-- interval_high_N: upper end of that interval
-- bias_N: mean of estimate - truth
-- worst_node_error_N: the largest of any instant
SELECT e.study_id, t.name AS study, e.regime, e.noise_level_id, n.label AS noise, e.family, e.sensor_count, e.method,
       f.title AS method_title, f.knowledge, e.instants, e.mean_abs_error_N, e.standard_error_N,
       e.mean_abs_error_N - 1.959963984540054 * e.standard_error_N AS interval_low_N,
       e.mean_abs_error_N + 1.959963984540054 * e.standard_error_N AS interval_high_N,
       e.rms_error_N, e.bias_N, e.worst_node_error_N, e.unverified_fraction, e.ambiguous_fraction
FROM (SELECT * FROM layout_error UNION ALL SELECT * FROM v_running_layout_error) e
CROSS JOIN study t USING (study_id) CROSS JOIN noise_level n USING (noise_level_id) CROSS JOIN fusion_method f USING (study_id, method);

-- The best method per regime, noise level, layout family and count, of those that need not know the direction; of a study
-- with [uncertainty] every set of sensors that was tried.
CREATE VIEW v_best_method AS
-- study_id: its study
-- study: its name
-- regime: of the instants; of a study with [uncertainty] 'whole motion'
-- noise_level_id: its noise level; none of a study with [uncertainty], whose sensors have each their own noise
-- noise: its label
-- family: of a study with [uncertainty] all named sets that it is, or the set in words
-- method_title: as figures write it
-- mean_abs_error_N: over instants and variants of the layout, or over worlds and the whole motion
-- interval_low_N: 95% interval of mean_abs_error_N
-- interval_high_N: upper end of that interval
SELECT e.study_id, t.name AS study, e.regime, e.noise_level_id, n.label AS noise, e.family, e.sensor_count, e.method,
       f.title AS method_title, e.mean_abs_error_N,
       e.mean_abs_error_N - 1.959963984540054 * e.standard_error_N AS interval_low_N,
       e.mean_abs_error_N + 1.959963984540054 * e.standard_error_N AS interval_high_N
FROM (SELECT study_id, regime, noise_level_id, family, sensor_count, method, mean_abs_error_N, standard_error_N
      FROM layout_error WHERE best = 1
      UNION ALL
      SELECT study_id, regime, noise_level_id, family, sensor_count, method, mean_abs_error_N, standard_error_N
      FROM v_running_layout_error WHERE best = 1) e
CROSS JOIN study t USING (study_id) CROSS JOIN noise_level n USING (noise_level_id) CROSS JOIN fusion_method f USING (study_id, method)
UNION ALL
SELECT e.study_id, e.study, 'whole motion', NULL, 'of each sensor', iif(c.families = '', c.words, c.families), c.sensor_count,
       'ensemble_filter', 'Ensemble filter', e.mean_abs_error_N,
       e.mean_abs_error_N - 1.959963984540054 * e.standard_error_N,
       e.mean_abs_error_N + 1.959963984540054 * e.standard_error_N
FROM v_world_error e CROSS JOIN world_candidate c USING (study_id, candidate_index) WHERE e.condition = 'as_stated';

-- What sensor_matrix will hold of the studies that still run.
CREATE VIEW v_running_sensor_matrix AS
-- study_id: its study
-- regime: of the instants
-- noise_level_id: its noise level
-- knowledge: whether the direction of motion is known
-- sensor_node: i, where the sensor is
-- node: j, where the error is
-- mean_abs_error_N: e_ij
SELECT s.study_id, s.regime, e.noise_level_id, e.knowledge, e.sensor_node, e.node, avg(e.mean_abs_error_N) AS mean_abs_error_N
FROM study t CROSS JOIN scenario s USING (study_id) CROSS JOIN single_sensor_node e USING (scenario_id)
WHERE t.status = 'running'
GROUP BY s.study_id, s.regime, e.noise_level_id, e.knowledge, e.sensor_node, e.node;

-- e_ij: the error at node j of the estimate from the sensor at node i, averaged over the instants of a regime.
CREATE VIEW v_single_sensor_matrix AS
-- study_id: its study
-- study: its name
-- regime: of the instants
-- noise_level_id: its noise level
-- noise: its label
-- knowledge: whether the direction of motion is known
-- sensor_node: i, where the sensor is
-- node: j, where the error is
-- mean_abs_error_N: e_ij
SELECT e.study_id, t.name AS study, e.regime, e.noise_level_id, n.label AS noise, e.knowledge, e.sensor_node, e.node,
       e.mean_abs_error_N
FROM (SELECT * FROM sensor_matrix UNION ALL SELECT * FROM v_running_sensor_matrix) e
CROSS JOIN study t USING (study_id) CROSS JOIN noise_level n USING (noise_level_id);

-- How far each study has come.
CREATE VIEW v_progress AS
-- study_id: its study
-- study: its name
-- units_done: stored work units
-- units: work units in all
SELECT t.study_id, t.name AS study, t.status, coalesce(sum(w.done), 0) AS units_done, count(w.unit_index) AS units
FROM study t LEFT JOIN work_unit w USING (study_id) GROUP BY t.study_id;

-- The recommendations in words, with layout and method names.
CREATE VIEW v_recommendation AS
-- recommendation_id: its number
-- study_id: its study
-- study: its name
-- noise: its label
-- scope: what is made small
-- layout: a name of the sensors
-- nodes: that carry sensors
-- method_title: as figures write it
-- interval_low_N: 95% interval of error_N
-- interval_high_N: upper end of that interval
SELECT r.recommendation_id, r.study_id, t.name AS study, n.label AS noise, r.scope, r.regime,
       (SELECT min(l.label) FROM layout l WHERE l.sensor_set_id = r.sensor_set_id) AS layout,
       ss.nodes, r.sensor_count, f.title AS method_title, r.error_N, r.interval_low_N, r.interval_high_N, r.sentence
FROM recommendation r JOIN study t USING (study_id) JOIN noise_level n USING (noise_level_id)
JOIN sensor_set ss USING (sensor_set_id) JOIN fusion_method f ON f.study_id = r.study_id AND f.method = r.method;

-- The diagnoses, each with the channel that it is judged by: the load's torque, else its first.
CREATE VIEW v_diagnosis AS
-- diagnosis_id: its number
-- channel: that it is judged by
-- sentence: the verdict in words
-- closed_high_fraction: upper end of that interval
SELECT d.diagnosis_id, d.recording, d.verdict, d.confidence_fraction, d.component, d.cable_end, d.position_m,
       c.channel, c.unit, c.rms_before_in_unit, c.rms_after_in_unit, c.rms_held_out_in_unit,
       c.closed_fraction, c.closed_low_fraction, c.closed_high_fraction, d.sentence
FROM diagnosis d LEFT JOIN diagnosis_channel c ON c.diagnosis_id = d.diagnosis_id AND c.channel_index = (
    SELECT channel_index FROM diagnosis_channel j WHERE j.diagnosis_id = d.diagnosis_id
    ORDER BY j.channel <> 'load_torque', j.channel_index LIMIT 1);

-- The error of each set of sensors of the studies with [uncertainty], over the worlds that were run.
CREATE VIEW v_world_error AS
-- study_id: its study
-- study: its name
-- candidate_index: the set, as in world_candidate
-- words: the set in words
-- condition: under what it was tried
-- worlds: how many; sets that lost early have few
-- standard_error_N: of mean_abs_error_N
SELECT e.study_id, t.name AS study, e.candidate_index, c.words, c.sensor_count, c.price, e.condition,
       count(*) AS worlds, avg(e.mean_abs_error_N) AS mean_abs_error_N,
       sqrt(max(avg(e.mean_abs_error_N * e.mean_abs_error_N) - avg(e.mean_abs_error_N) * avg(e.mean_abs_error_N), 0.0)
            / max(count(*) - 1, 1)) AS standard_error_N,
       avg(e.load_end_error_N) AS load_end_error_N, avg(e.worst_place_error_N) AS worst_place_error_N,
       avg(e.covered_fraction) AS covered_fraction
FROM world_error e JOIN world_candidate c USING (study_id, candidate_index) JOIN study t USING (study_id)
GROUP BY e.study_id, e.candidate_index, e.condition;
