#include "capstan/config/config_file.h"

#include <stdexcept>

#include "capstan/config/config_problem.h"
#include "capstan/config/toml_nodes.h"
#include "capstan/platform/files.h"

namespace capstan::config {

std::string content_of(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        throw ConfigError(file,
                          {{0, 0, "", "no such file; `capstan config default -o " + file + "` makes one"}});
    }
    if (std::filesystem::is_directory(path, ignored)) {
        throw ConfigError(file, {{0, 0, "", "is a folder; name the configuration file in it"}});
    }
    try {
        return read_file(path);
    } catch (const std::runtime_error&) {
        throw ConfigError(file, {{0, 0, "", "cannot be read; check its permissions"}});
    }
}

ConfigContent content_described_by(std::string_view toml) {
    try {
        const toml::table root = parsed(toml, "");
        const bool is_bench = root["kind"].value<std::string>() == "bench" || root.contains("pulleys");
        return is_bench ? ConfigContent::bench : ConfigContent::study;
    } catch (const toml::parse_error&) {
        return ConfigContent::study;
    }
}

ConfigContent content_of_config(const std::filesystem::path& path) {
    return content_described_by(content_of(path));
}

}  // namespace capstan::config
