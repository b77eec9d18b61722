#include "capstan/units/result_units.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "capstan/units/unit_record.h"

namespace capstan::units {

using nlohmann::json;

std::string quoted_json(const std::string& text) {
    return json(text).dump(-1, ' ', false, json::error_handler_t::replace);
}

namespace {

// Over the hashes of all units, so that none can be exchanged for another.
std::string hash_over(const std::vector<std::string>& inputs, const std::vector<std::string>& hashes) {
    std::string text;
    for (std::size_t k = 0; k < hashes.size(); ++k) text += hashes[k] + "  " + inputs[k] + "\n";
    return sha256_of(text);
}

std::string result_file(int unit, int count, const std::string& by) {
    return "shard-" + std::to_string(unit) + "-of-" + std::to_string(count) + by + ".json";
}

// Vector instructions of another width add in another order, so that last bits differ.
void require_one_program(const std::vector<UnitRecord>& records) {
    std::set<std::string> programs;
    for (const UnitRecord& record : records) programs.insert(record.computed_with);
    if (programs.size() > 1)
        throw std::runtime_error(
            "the shards were computed with different programs or vector instructions (" + *programs.begin() +
            " and " + *programs.rbegin() +
            "), so that their last bits may differ; submit into a new folder with --simd, and one "
            "program for all machines");
}

}  // namespace

bool ResultWork::is_merged() {
    return results_.modified_s(merged_results).has_value();
}

UnitWork::Computed ResultWork::compute(int unit, bool is_second, const std::function<bool()>& is_unwanted) {
    const Result result = produce_(unit, is_unwanted);
    if (result.end != WorkEnd::complete) return {result.end, {}};
    const std::string file = result_file(unit, count(), is_second ? "-by-" + leases_.worker() : "");
    results_.replace(file, result.text);
    return {WorkEnd::complete, file, sha256_of(result.text), units_.computed_with};
}

void ResultWork::discard(const std::string& file) {
    if (!file.empty()) results_.remove(file);
}

UnitWork::Merged ResultWork::merge() {
    Merged merged{WorkEnd::complete, {}};
    std::vector<UnitRecord> records;
    std::vector<std::string> hashes;
    std::string rows;
    for (int unit = 1; unit <= count(); ++unit) {
        const auto record = read_unit_record(leases_, unit);
        const std::string text = record ? results_.read(record->file).value_or("") : "";
        if (!record || sha256_of(text) != record->sha256) {
            merged.damaged.push_back(unit);
            continue;
        }
        const std::string& input = units_.inputs[static_cast<std::size_t>(unit - 1)];
        records.push_back(*record);
        hashes.push_back(record->sha256);
        rows += (rows.empty() ? "" : ",\n") + ("{\"shard\": " + std::to_string(unit)) +
                ", \"input\": " + quoted_json(input) + ", \"sha256\": \"" + record->sha256 +
                "\",\n\"answer\":\n" + text + "}";
    }
    if (!merged.damaged.empty()) return merged;
    require_one_program(records);
    results_.replace(merged_results, "{" + units_.head +
                                         "\"computed_with\": " + quoted_json(records.front().computed_with) +
                                         ", \"sha256\": \"" + hash_over(units_.inputs, hashes) +
                                         "\",\n\"shards\": [\n" + rows + "\n]}\n");
    return merged;
}

std::vector<std::string> problems_of_results(const std::string& text) {
    std::vector<std::string> problems, inputs, hashes;
    const json results = json::parse(text, nullptr, false);
    const auto has_text = [](const json& object, const char* key) {
        return object.is_object() && object.contains(key) && object[key].is_string();
    };
    const auto is_shard = [&](const json& shard) {
        return has_text(shard, "input") && has_text(shard, "sha256");
    };
    if (!has_text(results, "sha256") || !results.contains("shards") ||
        !std::all_of(results["shards"].begin(), results["shards"].end(), is_shard))
        return {"it is not the merged result of a batch"};
    // The bytes of an answer stand between its head and the next one's.
    constexpr std::string_view begin = "\n\"answer\":\n";
    std::size_t at = text.find("\"shards\": [\n");
    for (const json& shard : results["shards"]) {
        inputs.push_back(shard["input"]);
        hashes.push_back(shard["sha256"]);
        const std::size_t from = text.find(begin, at);
        if (from == std::string::npos) return {"it is not the merged result of a batch"};
        const std::size_t first = from + begin.size();
        const std::size_t next = text.find("},\n{\"shard\": ", first);
        const std::size_t end = next == std::string::npos ? text.rfind("}\n]}\n") : next;
        if (end == std::string::npos || end < first ||
            sha256_of(text.substr(first, end - first)) != hashes.back())
            problems.push_back("the answer to " + inputs.back() + " does not have its hash");
        at = end;
    }
    if (hash_over(inputs, hashes) != results["sha256"])
        problems.emplace_back("the hashes of the answers do not have the hash over them");
    return problems;
}

}  // namespace capstan::units
