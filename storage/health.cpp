#include "capstan/storage/health.h"

#include <algorithm>

#include "capstan/storage/statement.h"

namespace capstan::storage {
namespace {

int number_from(Database& database, const char* sql) {
    Statement statement(database, sql);
    statement.step();
    return statement.get<int>(0);
}

std::vector<std::string> problems_in(Database& database) {
    std::vector<std::string> problems;
    Statement pages(database, "PRAGMA integrity_check(20)");
    while (pages.step("check the pages")) {
        if (pages.get<std::string>(0) != "ok") problems.push_back(pages.get<std::string>(0));
    }
    Statement references(database, "PRAGMA foreign_key_check");
    while (references.step("check the references") && problems.size() < 20) {
        problems.push_back("a row of table " + references.get<std::string>(0) + " refers to nothing in " +
                           references.get<std::string>(2));
    }
    if (number_from(database,
                    "SELECT count(*) FROM study t WHERE status = 'complete' AND EXISTS "
                    "(SELECT 1 FROM work_unit w WHERE w.study_id = t.study_id AND done = 0)") > 0)
        problems.emplace_back("a study is called complete, but some of its units are not done");
    return problems;
}

std::vector<std::string> copies_of(const std::filesystem::path& path) {
    std::vector<std::string> names;
    const std::string begin = path.filename().string() + ".version";
    std::error_code none;
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(begin)) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

Health examine(Database& database) {
    Health health;
    health.problems = problems_in(database);
    health.studies = number_from(database, "SELECT count(*) FROM study");
    health.running_studies = number_from(database, "SELECT count(*) FROM study WHERE status = 'running'");
    health.diagnoses = number_from(database, "SELECT count(*) FROM diagnosis");
    health.cells = number_from(database, "SELECT count(*) FROM cell");
    health.copies = copies_of(database.path());
    return health;
}

}  // namespace capstan::storage
