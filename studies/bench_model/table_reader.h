#pragma once

#include <toml++/toml.h>

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "capstan/bench_model/bench_model.h"
#include "capstan/config/config_problem.h"

namespace capstan::bench_model {

/// Reads a table's keys one by one and notes every problem. A key that was not asked for is unknown.
class TableReader {
  public:
    enum class Range { positive, zero_or_more, finite };

    TableReader(const toml::table& table, std::string path, std::vector<config::ConfigProblem>& problems);

    bool has(const std::string& key) const { return table_.contains(key); }
    double number(const std::string& key, Range range);
    double number_or(const std::string& key, Range range, double otherwise);
    /// A number with its interval, if it has one.
    FittedNumber fitted(const std::string& name, const std::string& unit, Range range);
    int integer(const std::string& key, int low, int high);
    bool boolean(const std::string& key);
    std::string text(const std::string& key);
    std::string text_or(const std::string& key, const std::string& otherwise);
    std::vector<int> integers(const std::string& key);
    /// The rows of a list of tables; none where the key is missing.
    std::vector<TableReader> rows(const std::string& key);
    /// The table under a key; an empty one where it is missing.
    TableReader table(const std::string& key);
    /// In the order of their lines.
    std::vector<std::string> keys() const;

    void add_problem(const std::string& key, const std::string& message);
    /// Notes the keys that nobody asked for.
    void reject_other_keys();

  private:
    const toml::node* required(const std::string& key, const std::string& what);
    template <class Value>
    Value value_of(const std::string& key, bool (toml::node::*is_type)() const, const std::string& what);
    std::optional<FittedInterval> interval(const std::string& key);
    std::string full_name(const std::string& key) const;

    const toml::table& table_;
    std::string path_;
    std::vector<config::ConfigProblem>& problems_;
    std::set<std::string> known_;
};

}  // namespace capstan::bench_model
