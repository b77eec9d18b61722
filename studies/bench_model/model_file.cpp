#include "capstan/bench_model/model_file.h"

#include "capstan/config/config_problem.h"
#include "capstan/platform/files.h"

namespace capstan::bench_model {

using config::ConfigError;

bool names_a_model(const std::filesystem::path& path) {
    return path.extension() == ".toml";
}

BenchModel read_model(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
        throw ConfigError(file, {{0, 0, "",
                                  "no such file; `capstan diagnose LOG --save " + file +
                                      "` writes the model that a diagnosis finds"}});
    if (std::filesystem::is_directory(path, ignored))
        throw ConfigError(file, {{0, 0, "", "is a folder; name the model's file in it"}});
    return parse_model(read_file(path), file);
}

void require_model_name(const std::filesystem::path& path) {
    const std::string file = path.string();
    if (!names_a_model(path))
        throw ConfigError(file,
                          {{0, 0, "", "a model is written as TOML; give it a name that ends in .toml"}});
    std::error_code ignored;
    const bool is_there =
        std::filesystem::is_regular_file(path, ignored) && !std::filesystem::is_empty(path, ignored);
    if (is_there && !is_model(read_file(path)))
        throw ConfigError(file, {{0, 0, "",
                                  "exists and is not a model of a bench, so it is not overwritten; "
                                  "give the model another name"}});
}

void write_model(const std::filesystem::path& path, const BenchModel& model) {
    require_model_name(path);
    write_file(path, model_text(model));
}

}  // namespace capstan::bench_model
