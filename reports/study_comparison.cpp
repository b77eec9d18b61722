#include "capstan/reports/study_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "capstan/reports/html_text.h"
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
    if (rows.empty()) return "the studies have no regime, noise level, layout and method in common.";
    return fmt::format(
        "of {} errors that both studies have, that of the second is significantly smaller in {} and significantly "
        "larger in {} (unpaired test of each at the 5% level: of equal errors about 1 in 20 counts).",
        rows.size(), smaller, larger);
}

Data recommendation_rows(const Comparison& comparison) {
    Data rows = Data::list();
    for (const Row& row : comparison["compared_recommendation"].each()) {
        const std::string regime = row.text("regime");
        rows.push_back(
            {{"study", row.text("series")},
             {"for", regime.empty() ? row.text("scope") : regime_title(regime)},
             {"noise", row.text("noise")},
             {"nodes", row.text("nodes")},
             {"method", row.text("method_title")},
             {"error_N", row.number("error_N")},
             {"interval_95_N", Data::list({row.number("interval_low_N"), row.number("interval_high_N")})}});
    }
    return rows;
}

// The common errors that differ most, in units of their uncertainty.
Data largest_rows(const Comparison& comparison) {
    constexpr std::size_t shown = 12;
    auto rows = comparison["compared_error"].each();
    const auto significance = [](const Row& row) {
        const double half_N = row.number("interval_high_N") - row.number("difference_N");
        return half_N > 0 ? std::abs(row.number("difference_N")) / half_N : 0.0;
    };
    std::vector<std::size_t> order(rows.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return significance(rows[a]) > significance(rows[b]);
    });
    Data lines = Data::list();
    for (std::size_t k = 0; k < order.size() && k < shown; ++k) {
        const Row& row = rows[order[k]];
        lines.push_back(
            {{"regime", regime_title(row.text("regime"))},
             {"noise", row.text("noise")},
             {"layout", row.text("family")},
             {"sensor_count", row.integer("sensor_count")},
             {"method", row.text("method_title")},
             {"first_error_N", row.number("first_error_N")},
             {"second_error_N", row.number("second_error_N")},
             {"difference_N", row.number("difference_N")},
             {"interval_95_N", Data::list({row.number("interval_low_N"), row.number("interval_high_N")})}});
    }
    return lines;
}

}  // namespace

Answer study_comparison(storage::Database& database, const ComparedStudies& studies) {
    const Comparison comparison = compare(database, studies);
    Answer answer{.id = "comparison",
                  .kind = "Comparison of two studies",
                  .title = title_of(comparison.first) + " and " + title_of(comparison.second),
                  .headline = verdict(comparison)};
    answer.values = Data::record();
    for (const Table& table : comparison.tables) answer.values[table.name] = data_of(table);
    answer.sections = {{.id = "settings",
                        .heading = "Settings that differ",
                        .tables = {{"settings",
                                    "",
                                    {{"key", "key"}, {"first", "first study"}, {"second", "second study"}},
                                    answer.values["settings"]}}},
                       {.id = "advice",
                        .heading = "Recommendations",
                        .tables = {{"recommendations",
                                    "",
                                    {{"study", "study"},
                                     {"for", "for"},
                                     {"noise", "noise"},
                                     {"nodes", "nodes"},
                                     {"method", "method"},
                                     {"error_N", "error", "N", ".3f"},
                                     {"interval_95_N", "95% interval", "N", ".3f"}},
                                    recommendation_rows(comparison)}}},
                       {.id = "errors",
                        .heading = "Estimation error",
                        .tables = {{"differences",
                                    "The most significant differences, second minus first",
                                    {{"regime", "regime"},
                                     {"noise", "noise"},
                                     {"layout", "layout"},
                                     {"sensor_count", "sensors"},
                                     {"method", "method"},
                                     {"first_error_N", "first", "N", ".3f"},
                                     {"second_error_N", "second", "N", ".3f"},
                                     {"difference_N", "difference", "N", "+.3f"},
                                     {"interval_95_N", "95% interval", "N", "+.3f"}},
                                    largest_rows(comparison)}},
                        .note = "The intervals treat the draws of the two studies as independent."}};
    answer.csv_table = "compared_error";
    answer.drawn = comparison.tables;
    return answer;
}

}  // namespace capstan::reports
