#include "capstan/storage/integrity/verification.h"

#include <algorithm>
#include <map>
#include <set>

#include "capstan/platform/work_meter.h"
#include "capstan/storage/error.h"
#include "capstan/storage/integrity/hashed_rows.h"
#include "capstan/storage/integrity/world_hash.h"

namespace capstan::storage {
namespace {

using Part = std::pair<std::string, int>;                // as content_hash has it
using TableHashes = std::map<std::string, std::string>;  // by table

constexpr std::size_t max_problems = 20;

std::map<Part, TableHashes> stored_hashes(Database& database, std::int64_t study_id) {
    Statement select(database,
                     "SELECT part, part_index, table_name, sha256 FROM content_hash WHERE study_id = ?1");
    select.bind(1, study_id);
    std::map<Part, TableHashes> hashes;
    while (select.step("read the hashes"))
        hashes[{select.get<std::string>(0), select.get<int>(1)}][select.get<std::string>(2)] =
            select.get<std::string>(3);
    return hashes;
}

std::vector<int> done_units(Database& database, std::int64_t study_id) {
    Statement select(database, "SELECT unit_index FROM work_unit WHERE study_id = ?1 AND done = 1");
    select.bind(1, study_id);
    std::vector<int> units;
    while (select.step("read the units")) units.push_back(select.get<int>(0));
    return units;
}

class StudyCheck {
  public:
    StudyCheck(Database& database, std::int64_t study_id, std::string name, HashCheck& result)
        : database_(database),
          study_id_(study_id),
          name_("study " + std::to_string(study_id) + " (" + name + ")"),
          result_(result) {}

    void run(bool is_complete) {
        stored_ = stored_hashes(database_, study_id_);
        if (stored_.empty()) {
            result_.unhashed.push_back(name_);
            return;
        }
        try {
            const StudyIds ids = load_study_ids(database_, study_id_);
            compare({"description", 0}, digests_of(database_, ids, description_and_candidates(ids)));
            for (const int unit : done_units(database_, study_id_))
                compare({"unit", unit}, digests_of(database_, ids, unit_rows(database_, ids, unit)));
            for (const auto& [part, sum] : world_sums(database_, study_id_))
                compare(part, {{"world_error", sum}});
            if (is_complete) {
                compare({"conclusions", 0}, digests_of(database_, ids, conclusion_rows(study_id_)));
                compare({"study", 0}, digests_of(database_, ids, {hash_list_rows(study_id_)}));
            }
        } catch (const Error& error) {
            problem(error.what());
        }
        for (const auto& [part, tables] : stored_)
            if (compared_.count(part) == 0) problem(words_of(part) + " is gone, and its hash is still there");
    }

  private:
    std::vector<HashedRows> description_and_candidates(const StudyIds& ids) const {
        std::vector<HashedRows> tables = description_rows(ids);
        tables.push_back(candidate_rows(study_id_));
        return tables;
    }

    void compare(const Part& part, const TableHashes& found) {
        compared_.insert(part);
        ++result_.hashed;
        note_work(result_.work_of_part);
        const TableHashes& stored = stored_[part];
        std::set<std::string> tables;
        for (const auto& [table, sha256] : found) tables.insert(table);
        for (const auto& [table, sha256] : stored) tables.insert(table);
        for (const std::string& table : tables) {
            const auto was = stored.find(table);
            const auto is = found.find(table);
            if (was == stored.end())
                problem(words_of(part) + " has rows in table " + table + ", but no hash of them");
            else if (is == found.end())
                problem(words_of(part) + " has lost its rows in table " + table);
            else if (was->second != is->second)
                problem(words_of(part) + ": table " + table + " is not as it was written");
        }
    }

    std::string words_of(const Part& part) {
        const auto& [name, index] = part;
        if (name == "unit") return name_ + ", unit " + std::to_string(index) + unit_words(index);
        if (name.starts_with("worlds ")) {
            const std::int64_t first = std::int64_t{index} * worlds_per_block;  // a damaged index is large
            return name_ + ", " + name + ", numbers " + std::to_string(first) + " to " +
                   std::to_string(first + worlds_per_block - 1);
        }
        if (name == "study") return name_ + ", hash over all hashes";
        return name_ + ", " + name;
    }

    std::string unit_words(int unit) {
        Statement select(database_,
                         "SELECT w.stage, s.scenario_index, n.label FROM work_unit w JOIN scenario s USING "
                         "(scenario_id) JOIN noise_level n USING (noise_level_id) WHERE w.study_id = ?1 AND "
                         "unit_index = ?2");
        select.bind_all(study_id_, unit);
        if (!select.step()) return {};
        return " (stage " + select.get<std::string>(0) + ", instant " +
               std::to_string(select.get<std::int64_t>(1)) + ", noise '" + select.get<std::string>(2) + "')";
    }

    void problem(const std::string& text) {
        if (result_.problems.size() < max_problems) result_.problems.push_back(text);
    }

    Database& database_;
    std::int64_t study_id_;
    std::string name_;
    HashCheck& result_;
    std::map<Part, TableHashes> stored_;
    std::set<Part> compared_;
};

void check_diagnosis(Database& database, std::int64_t diagnosis_id, HashCheck& result) {
    const std::string name = "diagnosis " + std::to_string(diagnosis_id);
    Statement select(database, "SELECT table_name, sha256 FROM diagnosis_hash WHERE diagnosis_id = ?1");
    select.bind(1, diagnosis_id);
    TableHashes stored;
    while (select.step("read the hashes")) stored[select.get<std::string>(0)] = select.get<std::string>(1);
    if (stored.empty()) {
        result.unhashed.push_back(name);
        return;
    }
    ++result.hashed;
    TableHashes found = digests_of(database, {}, diagnosis_rows(diagnosis_id));
    for (const auto& [table, sha256] : stored) {
        if (found[table] != sha256 && result.problems.size() < max_problems)
            result.problems.push_back(name + ": table " + table + " is not as it was written");
        found.erase(table);
    }
    for (const auto& [table, sha256] : found)
        if (result.problems.size() < max_problems)
            result.problems.push_back(name + " has rows in table " + table + ", but no hash of them");
}

int hashed_parts(Database& database) {
    Statement count(database,
                    "SELECT count(*) FROM (SELECT DISTINCT study_id, part, part_index FROM content_hash)");
    count.step("count the hashes");
    return count.get<int>(0);
}

}  // namespace

HashCheck check_hashes(Database& database, double work) {
    HashCheck result;
    result.work_of_part = work / std::max(hashed_parts(database), 1);
    Statement studies(database, "SELECT study_id, name, status FROM study ORDER BY study_id");
    while (studies.step("read the studies"))
        StudyCheck(database, studies.get<std::int64_t>(0), studies.get<std::string>(1), result)
            .run(studies.get<std::string>(2) == "complete");
    Statement diagnoses(database, "SELECT diagnosis_id FROM diagnosis ORDER BY diagnosis_id");
    while (diagnoses.step("read the diagnoses"))
        check_diagnosis(database, diagnoses.get<std::int64_t>(0), result);
    return result;
}

}  // namespace capstan::storage
