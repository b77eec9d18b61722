#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <thread>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/program.h"
#include "capstan/cli/watched_run.h"
#include "capstan/platform/child_process.h"
#include "capstan/platform/simd_width.h"
#include "capstan/storage/error.h"
#include "capstan/storage/health.h"
#include "capstan/storage/schema.h"
#include "capstan/storage/study_store.h"
#include "capstan/verification/recomputation.h"

namespace capstan::cli {

namespace {

using reports::Data;

struct Tool {
    const char* program;
    const char* what_for;
};

// Optional: a study needs none of them.
constexpr Tool tools[] = {
    {"sbatch", "capstan study submit --slurm"},         {"sqlite3", "inspecting a database by hand"},
    {"python3", "custom plots (pandas, matplotlib)"},   {"Rscript", "custom plots"},
    {"chromium", "opening reports; any browser works"},
};

struct DatabaseState {
    std::string words;
    bool is_there = false;
    bool is_intact = true;
    storage::Health health;
};

DatabaseState state_of(const std::string& file) {
    DatabaseState state;
    if (!std::filesystem::exists(file)) {
        state.words = "does not exist yet; `capstan study run` creates it";
        return state;
    }
    state.is_there = true;
    try {
        storage::Database database = storage::Database::open_read_only(file, storage::SchemaCheck::none);
        state.health = storage::examine(database);
        state.is_intact = state.health.problems.empty();
        state.words = state.is_intact ? "integrity check passed" : "integrity check failed";
    } catch (const storage::Error& error) {
        state.is_intact = false;
        state.words = error.what();
    }
    return state;
}

std::string database_sentence(const std::string& file, const DatabaseState& state) {
    std::string text =
        fmt::format("Database {}: {}{}", file, state.words, state.words.ends_with('.') ? "" : ".");
    const storage::Health& health = state.health;
    if (state.is_there && health.studies + health.diagnoses > 0)
        text += fmt::format(" Studies: {}, diagnoses: {}, cells: {}.", health.studies, health.diagnoses,
                            health.cells);
    if (health.running_studies > 0)
        text += fmt::format(" Not complete: {}; `capstan study resume all --db {}` completes them.",
                            health.running_studies, file);
    if (health.hashed_parts > 0) text += fmt::format(" Content hashes: {} compared.", health.hashed_parts);
    if (!health.unhashed.empty())
        text += fmt::format(" Not hashed, because begun by an older version: {}.",
                            fmt::join(health.unhashed, ", "));
    for (const std::string& problem : health.problems) text += " " + problem + ".";
    for (const std::string& copy : health.copies)
        text += fmt::format(" {} is a copy from before a migration.", copy);
    return text;
}

reports::Answer answer_of(const std::string& file, const DatabaseState& state) {
    Data rows = Data::list();
    Data found = Data::record();
    for (const Tool& tool : tools) {
        found[tool.program] = is_on_path(tool.program);
        rows.push_back(
            {{"program", tool.program}, {"found", is_on_path(tool.program)}, {"purpose", tool.what_for}});
    }
    reports::Answer answer{
        .id = "doctor",
        .kind = "Installation",
        .title = "capstan " + program_version(),
        .headline = fmt::format("database schema {}, {} threads, SIMD {}.", storage::schema_version,
                                std::thread::hardware_concurrency(), simd_width())};
    answer.values = {{"program_version", program_version()},
                     {"schema_version", storage::schema_version},
                     {"simd", simd_width()},
                     {"processors", std::thread::hardware_concurrency()},
                     {"tools", found},
                     {"database",
                      {{"file", file},
                       {"is_there", state.is_there},
                       {"is_intact", state.is_intact},
                       {"words", state.words},
                       {"problems", state.health.problems},
                       {"studies", state.health.studies},
                       {"running_studies", state.health.running_studies},
                       {"diagnoses", state.health.diagnoses},
                       {"cells", state.health.cells},
                       {"hashed_parts", state.health.hashed_parts},
                       {"unhashed", state.health.unhashed},
                       {"copies_of_older_versions", state.health.copies}}}};
    answer.sections = {
        {.id = "tools",
         .heading = "Optional programs",
         .tables =
             {{"tools", "", {{"program", "program"}, {"found", "found"}, {"purpose", "used for"}}, rows}}},
        {.id = "database", .prose = database_sentence(file, state)}};
    return answer;
}

ExitCode run_doctor(const Invocation& invocation) {
    const std::string& file = invocation.text("db");
    ShownWork work(invocation, "reading " + file);
    const DatabaseState state = state_of(file);
    work.end();
    deliver_answer(invocation, answer_of(file, state));
    return state.is_intact ? ExitCode::success : ExitCode::database_problem;
}

}  // namespace

Command doctor_command() {
    return {
        .name = "doctor",
        .summary = "Check the installation and the integrity of the database.",
        .description =
            "Checks the program, the processor and the optional programs, reads every page of the "
            "database, checks every reference in it, and compares every content hash, so that a changed number "
            "is found and its study, unit and table are named. Changes nothing.",
        .options = {database_option, output_option, json_option, progress_option, help_option},
        .examples = {"capstan doctor", "capstan doctor --db other.db --json"},
        .run = run_doctor};
}

namespace {

std::string verification_headline(const Recomputation& found) {
    const std::size_t differences = found.problems.size();
    return fmt::format("{} of {} stored units computed again, {}.", found.compared, found.units,
                       differences == 0   ? "all with the same bits"
                       : differences == 1 ? "1 difference"
                                          : fmt::format("{} differences", differences));
}

reports::Answer verification_answer(std::int64_t id, const Sample& sample, const Recomputation& found) {
    reports::Answer answer{.id = "verify",
                           .kind = "A stored study, computed again",
                           .title = fmt::format("Study {}", id),
                           .headline = verification_headline(found)};
    Data rows = Data::list();
    for (const std::string& problem : found.problems) rows.push_back({{"problem", problem}});
    answer.values = {{"study_id", id},
                     {"units", found.units},
                     {"compared", found.compared},
                     {"seed", sample.seed},
                     {"problems", found.problems}};
    if (!found.problems.empty())
        answer.sections = {{.id = "problems",
                            .heading = "Differences",
                            .tables = {{"problems", "", {{"problem", "difference"}}, rows}}}};
    return answer;
}

ExitCode run_study_verify(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    use_simd_of(invocation, storage::read_computations(database, id));
    const Sample sample{invocation.number("share"),
                        invocation.has("seed") ? static_cast<std::uint64_t>(invocation.integer("seed"))
                                               : std::random_device()()};
    Recomputation found;
    const ExitCode code = watch(invocation, "verification", [&](const RunOptions& options) -> WatchedEnd {
        found = recompute(database, id, sample, options);
        return {
            found.end,
            {},
            found.end == RunEnd::stopped ? "Stopped; nothing was compared." : verification_headline(found),
            id};
    });
    if (code != ExitCode::success) return code;
    deliver_answer(invocation, verification_answer(id, sample, found));
    return found.problems.empty() ? ExitCode::success : ExitCode::database_problem;
}

}  // namespace

Command study_verify_command() {
    return {
        .name = "study verify",
        .summary = "Compute part of a study again and compare.",
        .description =
            "Computes a random part of a stored study's units again, with the vector instructions that it was "
            "computed with, and compares every stored number bit by bit. Names each unit and table that "
            "differs. Changes nothing. `capstan doctor` compares the content hashes of all units, which finds "
            "damage, but not a wrong computation.",
        .arguments = {study_argument},
        .options = {database_option,
                    {.name = "share",
                     .kind = OptionKind::number,
                     .value = "FRACTION",
                     .meaning = "Fraction of the units; at least one is computed.",
                     .default_value = "0.05",
                     .low = 1e-9,
                     .high = 1.0},
                    {.name = "seed",
                     .kind = OptionKind::integer,
                     .value = "S",
                     .meaning = "Seed of the choice; by default another one each time.",
                     .low = 0,
                     .high = 9.2e18},
                    jobs_option,
                    simd_option,
                    output_option,
                    json_option,
                    progress_option,
                    help_option},
        .examples = {"capstan study verify", "capstan study verify paper --db paper.db --share 1"},
        .run = run_study_verify,
        .when_stopped = stores_nothing};
}

}  // namespace capstan::cli
