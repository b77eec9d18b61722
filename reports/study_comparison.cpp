#include "capstan/reports/study_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "capstan/reports/experiment_page.h"
#include "capstan/reports/html_text.h"
#include "capstan/reports/plain_tables.h"
#include "capstan/reports/table.h"
#include "capstan/storage/report_queries.h"
#include "capstan/storage/study_store.h"

namespace capstan::reports {
namespace {

struct SettingDifference {
    std::string key;  // 'transmission.segments', 'noise[2].label'
    std::string first;
    std::string second;  // '': not there
};

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

std::map<std::string, std::string> settings_of(const std::string& toml) {
    std::map<std::string, std::string> settings;
    std::map<std::string, int> rows;
    std::istringstream lines(toml);
    std::string line, section;
    while (std::getline(lines, line)) {
        line = trimmed(line);
        if (line.empty() || line.front() == '#') continue;
        if (line.starts_with("[[")) {
            const std::string name = line.substr(2, line.find("]]") - 2);
            section = name + "[" + std::to_string(++rows[name]) + "].";
        } else if (line.front() == '[') {
            section = line.substr(1, line.find(']') - 1) + ".";
        } else if (const auto equals = line.find('='); equals != std::string::npos) {
            settings[section + trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
        }
    }
    return settings;
}

// Of two configurations with every key written out on a line of its own, as studies store them.
std::vector<SettingDifference> setting_differences(const std::string& first_toml,
                                                   const std::string& second_toml) {
    auto first = settings_of(first_toml);
    auto second = settings_of(second_toml);
    std::set<std::string> keys;
    for (const auto& [key, value] : first) keys.insert(key);
    for (const auto& [key, value] : second) keys.insert(key);
    std::vector<SettingDifference> differences;
    for (const std::string& key : keys) {
        if (first[key] != second[key]) differences.push_back({key, first[key], second[key]});
    }
    return differences;
}

constexpr storage::QueryLimits patient{.time_limit_s = 300};  // the limit of a report

struct Comparison {
    storage::StudyRecord first;
    storage::StudyRecord second;
    std::vector<Table> tables;

    const Table& operator[](std::string_view name) const {
        return *std::find_if(tables.begin(), tables.end(),
                             [&](const Table& each) { return each.name == name; });
    }
};

Table read(storage::Database& database, const ComparedStudies& studies, const char* name, const char* meaning,
           std::string_view sql) {
    auto result = storage::run_read_only(database, sql, {studies.first, studies.second}, patient);
    return {name, meaning, std::move(result.columns), std::move(result.rows)};
}

Comparison compare(storage::Database& database, const ComparedStudies& studies) {
    Comparison comparison{storage::load_study(database, studies.first).study,
                          storage::load_study(database, studies.second).study,
                          {}};
    Table settings{"settings", "In what the configurations differ", {"key", "first", "second"}, {}};
    for (const auto& each : setting_differences(comparison.first.config_toml, comparison.second.config_toml))
        settings.rows.push_back({each.key, each.first, each.second});
    comparison.tables = {
        std::move(settings),
        read(database, studies, "compared_recommendation", "What each recommends",
             storage::compared_recommendations_query),
        read(database, studies, "compared_best", "The best of each number of sensors, direction unknown",
             storage::compared_best_query),
        read(database, studies, "compared_error", "Errors of what both have, by layout, count and method",
             storage::compared_errors_query)};
    return comparison;
}

std::string title_of(const storage::StudyRecord& study) {
    return fmt::format("study {} ({})", study.study_id, study.name);
}

// How many of the common errors differ significantly in the second study.
std::string verdict(const Comparison& comparison) {
    int smaller = 0, larger = 0;
    const auto rows = comparison["compared_error"].each();
    for (const Row& row : rows) {
        smaller += row.number("interval_high_N") < 0 ? 1 : 0;
        larger += row.number("interval_low_N") > 0 ? 1 : 0;
    }
    const std::string pair =
        fmt::format("First: {}. Second: {}. ", title_of(comparison.first), title_of(comparison.second));
    if (rows.empty()) return pair + "They have no regime, noise level, layout and method in common.";
    return pair + fmt::format(
                      "Of {} errors that both have, the second's is clearly smaller in {} and clearly larger "
                      "in {}; the draws of the rest cannot tell.",
                      rows.size(), smaller, larger);
}

std::vector<std::vector<std::string>> recommendation_rows(const Comparison& comparison) {
    std::vector<std::vector<std::string>> rows;
    for (const Row& row : comparison["compared_recommendation"].each()) {
        const std::string regime = row.text("regime");
        rows.push_back({row.text("series"), regime.empty() ? row.text("scope") : regime_title(regime),
                        row.text("noise"), row.text("nodes"), row.text("method_title"),
                        newtons(row.number("error_N")),
                        newtons_between(row.number("interval_low_N"), row.number("interval_high_N"))});
    }
    return rows;
}

std::vector<std::vector<std::string>> setting_rows(const Comparison& comparison) {
    std::vector<std::vector<std::string>> rows;
    for (const Row& row : comparison["settings"].each())
        rows.push_back({row.text("key"), row.text("first"), row.text("second")});
    return rows;
}

// The common errors that differ most, in units of their uncertainty.
std::vector<std::vector<std::string>> largest_rows(const Comparison& comparison) {
    auto rows = comparison["compared_error"].each();
    const auto clear = [](const Row& row) {
        const double half_N = row.number("interval_high_N") - row.number("difference_N");
        return half_N > 0 ? std::abs(row.number("difference_N")) / half_N : 0.0;
    };
    std::vector<std::size_t> order(rows.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return clear(rows[a]) > clear(rows[b]); });
    std::vector<std::vector<std::string>> lines;
    for (std::size_t k = 0; k < order.size() && k < 12; ++k) {
        const Row& row = rows[order[k]];
        lines.push_back(
            {fmt::format("{}, {}, {}, {} sensors, {}", regime_title(row.text("regime")), row.text("noise"),
                         row.text("family"), row.integer("sensor_count"), row.text("method_title")),
             newtons(row.number("first_error_N")), newtons(row.number("second_error_N")),
             fmt::format("{:+.3g} N", row.number("difference_N")),
             fmt::format("{:+.3g} to {:+.3g} N", row.number("interval_low_N"),
                         row.number("interval_high_N"))});
    }
    return lines;
}

std::vector<NumberTable> number_tables(const Comparison& comparison) {
    return {{"In what the configurations differ", {"Key", "First", "Second"}, setting_rows(comparison)},
            {"What each recommends",
             {"Study", "For", "Noise", "Nodes", "Method", "Objective", "95% interval"},
             recommendation_rows(comparison)},
            {"The clearest differences, second less first",
             {"What", "First", "Second", "Difference", "95% interval"},
             largest_rows(comparison)}};
}

}  // namespace

std::string study_comparison_html(storage::Database& database, const ComparedStudies& studies) {
    const Comparison comparison = compare(database, studies);
    auto numbers = number_tables(comparison);
    ExperimentPage page;
    page.id = "comparison";
    page.kind = "Comparison of two studies";
    page.title = comparison.first.name + " and " + comparison.second.name;
    page.verdict = verdict(comparison);
    page.sections = {
        {"settings", "How they were set", "Keys that both have alike are left out.", {numbers[0]}, ""},
        {"advice", "What to do", "", {numbers[1]}, ""},
        {"errors",
         "Estimation error",
         "",
         {numbers[2]},
         "Intervals take the draws of the two studies for independent."}};
    page.tables = comparison.tables;
    page.program_version = comparison.second.program_version;
    return experiment_page_html(page);
}

std::string study_comparison_markdown(storage::Database& database, const ComparedStudies& studies) {
    const Comparison comparison = compare(database, studies);
    std::string text =
        fmt::format("# {} and {}\n\n{}\n", escape_markdown(comparison.first.name),
                    escape_markdown(comparison.second.name), escape_markdown(verdict(comparison)));
    for (const NumberTable& table : number_tables(comparison)) text += markdown_of(table);
    return text;
}

std::string study_comparison_json(storage::Database& database, const ComparedStudies& studies) {
    return tables_json(compare(database, studies).tables);
}

std::string study_comparison_csv(storage::Database& database, const ComparedStudies& studies) {
    const Comparison comparison = compare(database, studies);
    const Table& errors = comparison["compared_error"];
    return csv_text(errors.columns, errors.rows);
}

}  // namespace capstan::reports
