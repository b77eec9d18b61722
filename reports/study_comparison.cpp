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

constexpr double normal_95 = 1.959963984540054;

struct Comparison {
    storage::StudyRecord first;
    storage::StudyRecord second;
    std::string first_title;
    std::string second_title;
    std::vector<Table> tables;

    const std::string& title_of(std::string_view series) const {
        return series == "first" ? first_title : second_title;
    }

    const Table& operator[](std::string_view name) const {
        return *std::find_if(tables.begin(), tables.end(),
                             [&](const Table& each) { return each.name == name; });
    }
};

// The rows of both, sorted by the columns `order`.
Table beside(const ComparedStudy& first, const ComparedStudy& second, const char* name, const char* meaning,
             std::string_view sql, const std::vector<const char*>& order) {
    auto result = storage::run_read_only(first.database, sql, {first.study_id, "first"}, patient);
    auto other = storage::run_read_only(second.database, sql, {second.study_id, "second"}, patient);
    result.rows.insert(result.rows.end(), other.rows.begin(), other.rows.end());
    std::vector<std::size_t> columns;
    for (const char* column : order)
        columns.push_back(static_cast<std::size_t>(
            std::find(result.columns.begin(), result.columns.end(), column) - result.columns.begin()));
    std::stable_sort(result.rows.begin(), result.rows.end(), [&](const auto& a, const auto& b) {
        for (const std::size_t k : columns)
            if (a[k] != b[k]) return a[k] < b[k];
        return false;
    });
    return {name, meaning, std::move(result.columns), std::move(result.rows)};
}

// Errors of both where regime, noise label, layout family, count and method are the same. Intervals of
// differences take the two studies' draws for independent.
Table common_errors(const ComparedStudy& first, const ComparedStudy& second) {
    constexpr std::size_t key_columns = 5, title = 5, error = 6, standard_error = 7;
    const auto sql = storage::compared_errors_query;
    const auto one = storage::run_read_only(first.database, sql, {first.study_id}, patient);
    const auto other = storage::run_read_only(second.database, sql, {second.study_id}, patient);
    const auto key_of = [](const std::vector<Value>& row) {
        return std::vector<Value>(row.begin(), row.begin() + key_columns);
    };
    std::map<std::vector<Value>, const std::vector<Value>*> of_other;
    for (const auto& row : other.rows) of_other[key_of(row)] = &row;
    Table table{"compared_error",
                "Errors of what both have, by layout, count and method",
                {"regime", "noise", "family", "sensor_count", "method", "method_title", "first_error_N",
                 "second_error_N", "difference_N", "interval_low_N", "interval_high_N"},
                {}};
    for (const auto& row : one.rows) {
        const auto found = of_other.find(key_of(row));
        if (found == of_other.end()) continue;
        const auto number = [](const std::vector<Value>& from, std::size_t k) {
            return std::get<double>(from[k]);
        };
        const double first_N = number(row, error), second_N = number(*found->second, error);
        const double first_error = number(row, standard_error),
                     second_error = number(*found->second, standard_error);
        const double half_N = normal_95 * std::sqrt(first_error * first_error + second_error * second_error);
        std::vector<Value> line = found->first;
        const double difference_N = second_N - first_N;
        line.insert(line.end(), {row[title], first_N, second_N, difference_N, difference_N - half_N,
                                 difference_N + half_N});
        table.rows.push_back(std::move(line));
    }
    return table;
}

std::string title_of(const ComparedStudy& study, const std::string& name, bool with_file) {
    return fmt::format("study {} ({}){}", study.study_id, name,
                       with_file ? " of " + study.database.path().filename().string() : "");
}

Comparison compare(const ComparedStudy& first, const ComparedStudy& second) {
    Comparison comparison;
    comparison.first = storage::load_study(first.database, first.study_id).study;
    comparison.second = storage::load_study(second.database, second.study_id).study;
    const bool with_file = first.database.path() != second.database.path();
    comparison.first_title = title_of(first, comparison.first.name, with_file);
    comparison.second_title = title_of(second, comparison.second.name, with_file);
    Table settings{"settings", "In what the configurations differ", {"key", "first", "second"}, {}};
    for (const auto& each : setting_differences(comparison.first.config_toml, comparison.second.config_toml))
        settings.rows.push_back({each.key, each.first, each.second});
    comparison.tables = {
        std::move(settings),
        beside(first, second, "compared_recommendation", "What each recommends",
               storage::compared_recommendations_query, {"scope", "regime", "noise", "series"}),
        beside(first, second, "compared_best", "The best of each number of sensors, direction unknown",
               storage::compared_best_query, {"question", "series", "sensor_count"}),
        common_errors(first, second)};
    return comparison;
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

std::string question_title(const Row& recommendation) {
    const std::string scope = recommendation.text("scope");
    if (scope == "minimax_regret") return "safe in every regime";
    if (scope == "duty_cycle") return "duty cycle";
    return regime_title(recommendation.text("regime"));
}

Data recommendation_rows(const Comparison& comparison) {
    Data rows = Data::list();
    for (const Row& row : comparison["compared_recommendation"].each()) {
        rows.push_back(
            {{"study", comparison.title_of(row.text("series"))},
             {"for", question_title(row)},
             {"noise", row.text("noise")},
             {"nodes", row.text("nodes")},
             {"method", row.text("method_title")},
             {"error_N", row.number("error_N")},
             {"interval_95_N", Data::list({row.number("interval_low_N"), row.number("interval_high_N")})}});
    }
    return rows;
}

// As the figure names its panels and its series, in words.
Table best_in_words(const Comparison& comparison) {
    Table best = comparison["compared_best"];
    for (std::vector<Value>& row : best.rows) {
        const std::string question = std::get<std::string>(row[0]);
        const std::size_t comma = question.find(", ");
        row[0] = regime_title(question.substr(0, comma)) + "; noise " + question.substr(comma + 2);
        row[1] = comparison.title_of(std::get<std::string>(row[1]));
    }
    return best;
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

Answer study_comparison(const ComparedStudy& first, const ComparedStudy& second) {
    const Comparison comparison = compare(first, second);
    Answer answer{.id = "comparison",
                  .kind = "Comparison of two studies",
                  .title = comparison.first_title + " and " + comparison.second_title,
                  .headline = verdict(comparison)};
    answer.values = Data::record();
    for (const Table& table : comparison.tables) answer.values[table.name] = data_of(table);
    answer.sections = {
        {.id = "settings",
         .heading = "Settings that differ",
         .tables = {{"settings",
                     "",
                     {{"key", "key"}, {"first", comparison.first_title}, {"second", comparison.second_title}},
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
    for (Table& table : answer.drawn)
        if (table.name == "compared_best") table = best_in_words(comparison);
    return answer;
}

}  // namespace capstan::reports
