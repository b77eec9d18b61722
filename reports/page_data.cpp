#include "capstan/reports/page_data.h"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "capstan/reports/figure_catalogue.h"
#include "capstan/reports/html_text.h"

namespace capstan::reports {
namespace {

using Json = nlohmann::ordered_json;

// More digits than a screen or a printer resolves; all digits are in the database and in the JSON report.
double rounded(double value) {
    return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

Json compact(const Value& value) {
    if (const auto* number = std::get_if<double>(&value)) return rounded(*number);
    return to_json(value);
}

// A column with repeated values: each distinct value once, and an index per row. Equal neighbours share one
// index: `runs` is their number.
Json repeated_values(Json words, const std::vector<std::size_t>& index) {
    std::vector<std::size_t> runs, first;
    for (std::size_t k = 0; k < index.size(); ++k) {
        if (k > 0 && index[k] == index[k - 1]) {
            ++runs.back();
        } else {
            first.push_back(index[k]);
            runs.push_back(1);
        }
    }
    if (2 * runs.size() < index.size())
        return {{"words", std::move(words)}, {"index", first}, {"runs", runs}};
    return {{"words", std::move(words)}, {"index", index}};
}

Json column_json(const Table& table, std::size_t column) {
    Json values = Json::array();
    for (const auto& row : table.rows) values.push_back(compact(row[column]));
    std::unordered_map<std::string, std::size_t> place_of;
    Json words = Json::array();
    std::vector<std::size_t> index;
    for (const Json& value : values) {
        const std::string word = value.dump(-1, ' ', false, Json::error_handler_t::replace);
        const auto [place, added] = place_of.emplace(word, words.size());
        if (added) words.push_back(value);
        index.push_back(place->second);
        constexpr std::size_t times = 4;  // with fewer repetitions an index is as long as the value
        if (words.size() * times > table.rows.size()) return values;
    }
    return repeated_values(std::move(words), index);
}

// By columns: a table of many thousand rows needs a third of the bytes, and only the columns that are drawn
// are unpacked.
Json table_json(const Table& table) {
    Json values = Json::array();
    for (std::size_t k = 0; k < table.columns.size(); ++k) values.push_back(column_json(table, k));
    return {{"meaning", table.meaning},
            {"columns", table.columns},
            {"rows", table.rows.size()},
            {"values", std::move(values)}};
}

// So that no text of a study can end the script element or begin a comment in it.
std::string safe_in_script(const Json& json) {
    const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (const char letter : text) {
        if (letter == '<' || letter == '>' || letter == '&') {
            safe += fmt::format("\\u{:04x}", static_cast<unsigned>(letter));
        } else {
            safe += letter;
        }
    }
    return safe;
}

}  // namespace

std::string page_data(const Tables& tables, std::string_view page) {
    Json data;
    for (const Table& table : tables.all()) {
        if (table.name != "study") data["tables"][table.name] = table_json(table);
    }
    for (const Figure& figure : figures()) {
        if (figure.page == page) data["figures"][figure.id] = Json::parse(figure.spec);
    }
    data["regime_titles"] = Json::object();
    if (const Table* regimes = tables.find("regime")) {
        for (const Row& regime : regimes->each())
            data["regime_titles"][regime.text("regime")] = regime_title(regime.text("regime"));
    }
    return safe_in_script(data);
}

}  // namespace capstan::reports
