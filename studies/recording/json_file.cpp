#include <nlohmann/json.hpp>
#include <stdexcept>

#include "capstan/cable/invalid_input.h"
#include "capstan/platform/files.h"
#include "capstan/recording/csv_numbers.h"
#include "capstan/recording/json_object.h"

namespace capstan {

std::string read_input_file(const std::filesystem::path& path) {
    try {
        return read_file(path);
    } catch (const std::runtime_error&) {
        throw InvalidInput({path.string() + ": cannot be read; does the file exist?"});
    }
}

nlohmann::json read_json_file(const std::filesystem::path& path) {
    const std::string text = read_input_file(path);
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception& error) {  // not only parse_error: 1e999 is out of range
        // The problem and its place follow the library's own error code.
        const std::string message = error.what();
        const std::size_t start = message.find("] ");
        throw InvalidInput({path.string() + ": is not JSON: " +
                            (start == std::string::npos ? message : message.substr(start + 2))});
    }
}

}  // namespace capstan
