#include "capstan/reports/page_data.h"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "capstan/reports/figure_catalogue.h"
#include "capstan/reports/html_text.h"

namespace capstan::reports {
namespace {

using Json = nlohmann::ordered_json;

// More digits than any eye or printer resolves; the full ones are in the database and in the JSON report.
double rounded(double value) {
    return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

Json compact(const Value& value) {
    if (const auto* number = std::get_if<double>(&value)) return rounded(*number);
    return to_json(value);
}

Json table_json(const Table& table) {
    Json rows = Json::array();
    for (const auto& row : table.rows) {
        Json values = Json::array();
        for (const Value& value : row) values.push_back(compact(value));
        rows.push_back(std::move(values));
    }
    return {{"meaning", table.meaning}, {"columns", table.columns}, {"rows", std::move(rows)}};
}

// No text of a study can end the element or begin a comment in it.
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
