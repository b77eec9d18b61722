#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/program.h"
#include "capstan/platform/child_process.h"
#include "capstan/storage/error.h"
#include "capstan/storage/health.h"
#include "capstan/storage/schema.h"

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
    std::string text = fmt::format("Database {}: {}.", file, state.words);
    const storage::Health& health = state.health;
    if (state.is_there && health.studies + health.diagnoses > 0)
        text += fmt::format(" Studies: {}, diagnoses: {}, cells: {}.", health.studies, health.diagnoses,
                            health.cells);
    if (health.running_studies > 0)
        text += fmt::format(" Not complete: {}; `capstan study resume all --db {}` completes them.",
                            health.running_studies, file);
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
                                std::thread::hardware_concurrency(), simd_in_use())};
    answer.values = {{"program_version", program_version()},
                     {"schema_version", storage::schema_version},
                     {"simd", simd_in_use()},
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
    const DatabaseState state = state_of(file);
    deliver_answer(invocation, answer_of(file, state));
    return state.is_intact ? ExitCode::success : ExitCode::database_problem;
}

}  // namespace

Command doctor_command() {
    return {.name = "doctor",
            .summary = "Check the installation and the integrity of the database.",
            .description =
                "Checks the program, the processor and the optional programs, reads every page of the "
                "database, and checks every reference in it. Changes nothing.",
            .options = {database_option, output_option, json_option, help_option},
            .examples = {"capstan doctor", "capstan doctor --db other.db --json"},
            .run = run_doctor};
}

}  // namespace capstan::cli
