#include "capstan/recording/json_file.h"

#include <nlohmann/json.hpp>

#include "capstan/cable/invalid_input.h"
#include "capstan/recording/csv_numbers.h"

namespace capstan {

nlohmann::json read_json_file(const std::filesystem::path& path) {
    const std::string text = file_text(path);
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception& error) {  // not only parse_error: 1e999 is out of range
        // What is wrong, and where, stands behind a code of the library's own.
        const std::string message = error.what();
        const std::size_t start = message.find("] ");
        throw InvalidInput({path.string() + ": no JSON: " +
                            (start == std::string::npos ? message : message.substr(start + 2))});
    }
}

}  // namespace capstan
