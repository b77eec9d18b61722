#include "capstan/storage/migration.h"

#include "capstan/platform/files.h"
#include "capstan/storage/error.h"
#include "capstan/storage/file_identity.h"
#include "capstan/storage/statement.h"
#include "capstan/storage/transaction.h"

namespace capstan::storage {
namespace {

int version_of(Database& database) {
    Statement statement(database, "PRAGMA user_version");
    statement.step();
    return statement.get<int>(0);
}

// Written under another name first: a copy that carries the final name is complete and on the disk.
void leave_copy(Database& database, int version) {
    const std::string copy = database.path().string() + ".version" + std::to_string(version);
    const std::string unfinished = copy + ".unfinished";
    std::filesystem::remove(unfinished);
    Statement statement(database, "VACUUM INTO ?1");
    statement.bind(1, unfinished);
    statement.run("copy the file before its migration");
    rename_durably(unfinished, copy);
}

const Migration& step_from(std::span<const Migration> steps, int version, const Database& database) {
    for (const Migration& step : steps) {
        if (step.from_version == version) return step;
    }
    throw Error(database.path().string() + " has schema version " + std::to_string(version) +
                ", from which this program knows no way to its own. Use the capstan that wrote it.");
}

void require_intact_references(Database& database) {
    Statement statement(database, "PRAGMA foreign_key_check");
    if (statement.step()) {
        throw Error(database.path().string() + " was not migrated: a row of table " +
                    statement.get<std::string>(0) + " would refer to nothing. Please report this.");
    }
}

}  // namespace

std::span<const Migration> migrations() {
    // A migration is the SQL of its time and does not follow schema.sql.
    static const Migration steps[] = {
        {1,
         R"sql(-- A study with [uncertainty] compares sets of sensors in worlds. The sets that could be bought; 0 has no sensor.
CREATE TABLE world_candidate (
    study_id        INTEGER NOT NULL REFERENCES study ON DELETE CASCADE,  -- its study
    candidate_index INTEGER NOT NULL CHECK (candidate_index >= 0),  -- 0, 1, ... by price
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
)sql"},
        {2,
         R"sql(ALTER TABLE diagnosis ADD COLUMN friction_low_ratio REAL;
ALTER TABLE diagnosis ADD COLUMN friction_high_ratio REAL;
ALTER TABLE diagnosis ADD COLUMN stiffness_low_ratio REAL;
ALTER TABLE diagnosis ADD COLUMN stiffness_high_ratio REAL;
ALTER TABLE diagnosis ADD COLUMN pretension_low_ratio REAL;
ALTER TABLE diagnosis ADD COLUMN pretension_high_ratio REAL;
ALTER TABLE diagnosis_number ADD COLUMN low_in_unit REAL;
ALTER TABLE diagnosis_number ADD COLUMN high_in_unit REAL;
)sql"},
        {3,
         R"sql(ALTER TABLE diagnosis_effect ADD COLUMN present_fraction REAL;
ALTER TABLE diagnosis_effect ADD COLUMN varies TEXT NOT NULL DEFAULT '';
)sql"},
        {4,
         R"sql(-- What was done to a study, when and by which command. The one table with a clock: no answer is made of it.
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
)sql"},
        {5,
         R"sql(-- SHA-256 of what is stored of a study, written in the transaction that stores it: `capstan doctor` and a merge work it
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
)sql"},
        {6,
         R"sql(DROP VIEW v_best_method;
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
)sql"}};
    return steps;
}

void migrate(Database& database, std::span<const Migration> steps, int target_version) {
    const int found = version_of(database);
    if (found > target_version) refuse_newer(database.path(), found);
    if (found == target_version) return;
    leave_copy(database, found);
    // A step may rebuild a table; dropping the old one must not cascade. The check follows before the commit.
    database.execute("PRAGMA foreign_keys = OFF", "prepare the migration");
    {
        Transaction transaction(database);
        for (int version = version_of(database); version < target_version; ++version) {
            database.execute(step_from(steps, version, database).sql, "migrate the tables");
        }
        database.execute("PRAGMA user_version = " + std::to_string(target_version), "migrate the tables");
        require_intact_references(database);
        transaction.commit();
    }
    database.execute("PRAGMA foreign_keys = ON", "end the migration");
}

}  // namespace capstan::storage
