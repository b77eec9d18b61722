#include "capstan/storage/health.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "capstan/platform/work_meter.h"
#include "capstan/storage/integrity/verification.h"
#include "capstan/storage/schema.h"
#include "capstan/storage/statement.h"

namespace capstan::storage {
namespace {

int number_from(Database& database, const char* sql) {
    Statement statement(database, sql);
    statement.step();
    return statement.get<int>(0);
}

// Of the time, measured on a study of 6 MB.
constexpr double pages_fraction = 0.25;
constexpr double references_fraction = 0.10;
constexpr double hashes_fraction = 1.0 - pages_fraction - references_fraction;

std::vector<std::string> problems_in(Database& database) {
    std::vector<std::string> problems;
    Statement pages(database, "PRAGMA integrity_check(20)");
    while (pages.step("check the pages")) {
        if (pages.get<std::string>(0) != "ok") problems.push_back(pages.get<std::string>(0));
    }
    note_work(pages_fraction);
    Statement references(database, "PRAGMA foreign_key_check");
    while (references.step("check the references") && problems.size() < 20) {
        problems.push_back("a row of table " + references.get<std::string>(0) + " refers to nothing in " +
                           references.get<std::string>(2));
    }
    note_work(references_fraction);
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

struct SchemaPart {
    std::string type;  // "table", "view", "index" or "trigger"
    std::string text;  // of its CREATE, without comments, with single blanks
    std::string columns;

    // A table that was migrated has its columns in another order and text.
    bool operator==(const SchemaPart& other) const {
        return type == other.type && (text == other.text || (type == "table" && columns == other.columns));
    }
};
using Schema = std::map<std::string, SchemaPart>;  // by name

std::string without_comments(const std::string& sql) {
    std::string text;
    for (std::size_t k = 0; k < sql.size(); ++k) {
        if (sql.compare(k, 2, "--") == 0) k = std::min(sql.find('\n', k), sql.size());
        const bool blank = k >= sql.size() || std::isspace(static_cast<unsigned char>(sql[k])) != 0;
        if (!blank)
            text += sql[k];
        else if (!text.ends_with(' '))
            text += ' ';
    }
    return text;
}

std::string columns_of(Database& database, const std::string& table) {
    Statement statement(database,
                        "SELECT name, type, \"notnull\", ifnull(dflt_value, ''), pk, hidden FROM "
                        "pragma_table_xinfo(?1) ORDER BY name");
    statement.bind(1, table);
    std::string text;
    while (statement.step("read the columns of a table")) {
        for (int k = 0; k < 6; ++k) text += statement.get<std::string>(k) + ' ';
        text += '\n';
    }
    return text;
}

Schema schema_of(Database& database) {
    Schema schema;
    Statement statement(
        database, "SELECT type, name, sql FROM sqlite_schema WHERE name NOT LIKE 'sqlite\\_%' ESCAPE '\\'");
    while (statement.step("read the schema"))
        schema[statement.get<std::string>(1)] = {
            statement.get<std::string>(0), without_comments(statement.get<std::string>(2)), {}};
    return schema;
}

const Schema& our_schema() {
    static const Schema ours = [] {
        Database database = Database::in_memory();
        database.execute(schema_text(), "create the tables");
        Schema schema = schema_of(database);
        for (auto& [name, part] : schema)
            if (part.type == "table") part.columns = columns_of(database, name);
        return schema;
    }();
    return ours;
}

}  // namespace

std::vector<std::string> schema_problems(Database& database) {
    Schema found = schema_of(database);
    std::vector<std::string> problems;
    for (const auto& [name, part] : our_schema()) {
        const auto there = found.find(name);
        if (there == found.end()) {
            problems.push_back("the " + part.type + " " + name + " is missing");
            continue;
        }
        SchemaPart& theirs = there->second;
        if (theirs.type == "table" && theirs.text != part.text) theirs.columns = columns_of(database, name);
        if (!(theirs == part)) problems.push_back("the " + part.type + " " + name + " was changed");
    }
    for (const auto& [name, part] : found)
        if (part.type == "trigger") problems.push_back("the trigger " + name + " is not capstan's");
    return problems;
}

Health examine(Database& database) {
    Health health;
    health.problems = schema_problems(database);
    if (!health.problems.empty()) return health;
    expect_work(pages_fraction + references_fraction + hashes_fraction);
    health.problems = problems_in(database);
    HashCheck hashes = check_hashes(database, hashes_fraction);
    health.hashed_parts = hashes.hashed;
    health.unhashed = std::move(hashes.unhashed);
    health.problems.insert(health.problems.end(), hashes.problems.begin(), hashes.problems.end());
    health.studies = number_from(database, "SELECT count(*) FROM study");
    health.running_studies = number_from(database, "SELECT count(*) FROM study WHERE status = 'running'");
    health.diagnoses = number_from(database, "SELECT count(*) FROM diagnosis");
    health.cells = number_from(database, "SELECT count(*) FROM cell");
    health.copies = copies_of(database.path());
    return health;
}

}  // namespace capstan::storage
