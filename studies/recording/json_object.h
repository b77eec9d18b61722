#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capstan/recording/problem_list.h"

namespace capstan {

/// An object of a JSON file with its place in the file, so that a problem names its key. A value that is
/// missing or of the wrong kind is noted as a problem and read as its type's empty value.
class JsonObject {
  public:
    JsonObject(const nlohmann::json& json, std::string place, ProblemList& problems);

    bool has(const char* key) const;
    bool is_number(const char* key) const;
    bool is_object(const char* key) const;
    double number(const char* key) const;
    double positive(const char* key) const;
    std::optional<double> optional_number(const char* key) const;
    /// Two positive numbers [low, high], if the value is a list.
    std::optional<std::pair<double, double>> optional_range(const char* key) const;
    int integer(const char* key) const;
    std::string text(const char* key) const;
    std::vector<std::string> texts(const char* key) const;
    JsonObject object(const char* key) const;
    /// Each element as an object.
    std::vector<JsonObject> objects(const char* key) const;
    std::vector<std::string> keys() const;

    void add_problem(const std::string& key, const std::string& problem) const;

  private:
    const nlohmann::json* find(const char* key) const;
    std::string path_of(const std::string& key) const;

    const nlohmann::json* json_;
    std::string place_;
    ProblemList* problems_;
};

/// The bytes of a file that the user named. Throws InvalidInput if it cannot be read.
std::string read_input_file(const std::filesystem::path& path);

/// Throws InvalidInput with file, line and column if the file cannot be read or is not JSON.
nlohmann::json read_json_file(const std::filesystem::path& path);

}  // namespace capstan
