#pragma once

#include <toml++/toml.h>

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "capstan/recording/problem_list.h"

namespace capstan::imports {

/// A table of a mapping. Every getter notes what is wrong with its key, with file and line, and then returns
/// nothing.
class MappingTable {
  public:
    MappingTable(const toml::table& table, std::string path, const std::string& file, ProblemList& problems)
        : table_(&table), path_(std::move(path)), file_(&file), problems_(&problems) {}

    /// Notes every key that is not among these.
    void knows(std::initializer_list<const char*> names) const;

    std::optional<std::string> text(const char* key) const;
    std::optional<double> number(const char* key) const;
    std::optional<double> positive(const char* key) const;
    std::optional<bool> boolean(const char* key) const;
    std::vector<std::string> texts(const char* key) const;

    void problem(const toml::node& node, const std::string& key, const std::string& what) const;
    void problem(const std::string& key, const std::string& what) const { problem(*table_, key, what); }
    const toml::table& toml() const { return *table_; }
    std::string path_of(const std::string& key) const { return path_ + key + "."; }
    MappingTable inside(const toml::table& table, const std::string& path) const {
        return {table, path, *file_, *problems_};
    }

  private:
    const toml::table* table_;
    std::string path_;  ///< "channels.motor_angle."
    const std::string* file_;
    ProblemList* problems_;
};

/// The keys of a table as the file has them; toml++ sorts them.
std::vector<std::string> keys_in_order(const toml::table& table);

/// The same value as JSON, its keys as the file has them; dates as texts.
nlohmann::ordered_json json_of(const toml::node& node);

}  // namespace capstan::imports
