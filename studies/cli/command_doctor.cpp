#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/program.h"
#include "capstan/cli/simd_choice.h"
#include "capstan/platform/child_process.h"
#include "capstan/storage/error.h"
#include "capstan/storage/health.h"
#include "capstan/storage/schema.h"

namespace capstan::cli {

namespace {

using nlohmann::ordered_json;

struct Tool {
    const char* program;
    const char* what_for;
};

// None is needed to run a study.
constexpr Tool tools[] = {
    {"sbatch", "capstan study submit --slurm"},
    {"sqlite3", "looking into a database by hand"},
    {"python3", "plots of your own (pandas, matplotlib)"},
    {"Rscript", "plots of your own"},
    {"chromium", "opening reports; any browser does"},
};

struct DatabaseState {
    std::string words;
    bool is_there = false;
    bool is_whole = true;
    storage::Health health;
};

DatabaseState state_of(const std::string& file) {
    DatabaseState state;
    if (!std::filesystem::exists(file)) {
        state.words = "not there; `capstan study run` makes it";
        return state;
    }
    state.is_there = true;
    try {
        storage::Database database = storage::Database::open_read_only(file);
        state.health = storage::examine(database);
        state.is_whole = state.health.problems.empty();
        state.words = state.is_whole ? "whole" : "damaged";
    } catch (const storage::Error& error) {
        state.is_whole = false;
        state.words = error.what();
    }
    return state;
}

ordered_json in_json(const std::string& file, const DatabaseState& state) {
    ordered_json json = {{"program_version", program_version()},
                         {"schema_version", storage::schema_version},
                         {"simd", simd_in_use()},
                         {"processors", std::thread::hardware_concurrency()},
                         {"tools", ordered_json::object()}};
    for (const Tool& tool : tools) json["tools"][tool.program] = is_on_path(tool.program);
    json["database"] = {{"file", file},
                        {"is_there", state.is_there},
                        {"is_whole", state.is_whole},
                        {"words", state.words},
                        {"problems", state.health.problems},
                        {"studies", state.health.studies},
                        {"running_studies", state.health.running_studies},
                        {"diagnoses", state.health.diagnoses},
                        {"cells", state.health.cells},
                        {"copies_of_older_versions", state.health.copies}};
    return json;
}

std::string in_words(const std::string& file, const DatabaseState& state) {
    std::string text = fmt::format("Program     capstan {}, database schema {}\n", program_version(),
                                   storage::schema_version);
    text +=
        fmt::format("Processor   {} threads, SIMD {}\n", std::thread::hardware_concurrency(), simd_in_use());
    for (const Tool& tool : tools)
        text += fmt::format("{:<11} {:<9} {}\n", tool.program, is_on_path(tool.program) ? "found" : "missing",
                            tool.what_for);
    text += fmt::format("Database    {}: {}\n", file, state.words);
    const storage::Health& health = state.health;
    if (!state.is_there || health.studies + health.diagnoses == 0) return text;
    text += fmt::format("            {} studies, {} diagnoses, {} cells\n", health.studies, health.diagnoses,
                        health.cells);
    if (health.running_studies > 0)
        text += fmt::format("            {} not complete: capstan study resume all --db {}\n",
                            health.running_studies, file);
    for (const std::string& problem : health.problems) text += fmt::format("            {}\n", problem);
    for (const std::string& copy : health.copies)
        text += fmt::format("            {} is a copy from before a migration\n", copy);
    return text;
}

ExitCode run(const Invocation& invocation) {
    const std::string& file = invocation.text("db");
    const DatabaseState state = state_of(file);
    deliver(invocation, invocation.has("json") ? json_text(in_json(file, state)) : in_words(file, state));
    return state.is_whole ? ExitCode::success : ExitCode::database_problem;
}

}  // namespace

Command doctor_command() {
    return {
        "doctor",
        "Say what is installed and whether the database is whole.",
        "Looks at the program, the processor and the programs that some commands or plots use, reads every page of "
        "the database and checks every reference in it. Changes nothing.",
        {},
        {database_option, output_option, json_option, help_option},
        {"capstan doctor", "capstan doctor --db results/capstan.db --json"},
        run};
}

}  // namespace capstan::cli
