// The installation, and the integrity of a database and of a study.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <thread>

#include "capstan/answers/study_answers.h"
#include "capstan/platform/child_process.h"
#include "capstan/platform/simd_width.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/reports/page_frame.h"
#include "capstan/storage/error.h"
#include "capstan/storage/schema.h"

namespace capstan::answers {

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

std::string verification_headline(const Recomputation& found) {
    const std::size_t differences = found.problems.size();
    return fmt::format("{} of {} stored units computed again, {}.", found.compared, found.units,
                       differences == 0 ? "all with the same bits" : counted(differences, "difference"));
}

}  // namespace

DatabaseState state_of_database(const std::filesystem::path& file) {
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

reports::Answer installation_answer(const std::string& file, const DatabaseState& state) {
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
        .title = "capstan " + reports::program_version(),
        .headline = fmt::format("database schema {}, {} threads, SIMD {}.", storage::schema_version,
                                std::thread::hardware_concurrency(), simd_width())};
    answer.values = {{"program_version", reports::program_version()},
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

reports::Answer verification_answer(std::int64_t study_id, const Sample& sample, const Recomputation& found) {
    reports::Answer answer{.id = "verify",
                           .kind = "A stored study, computed again",
                           .title = fmt::format("Study {}", study_id),
                           .headline = verification_headline(found)};
    Data rows = Data::list();
    for (const std::string& problem : found.problems) rows.push_back({{"problem", problem}});
    answer.values = {{"study_id", study_id},
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

}  // namespace capstan::answers
