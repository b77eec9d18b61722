#include "capstan/import/log_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/units.h"

namespace capstan::imports {

namespace {

// A log given twice would count twice, whichever names it has.
void require_each_once(const std::vector<std::filesystem::path>& files) {
    std::error_code missing;  // which is told where the file is read
    for (std::size_t k = 1; k < files.size(); ++k) {
        for (std::size_t before = 0; before < k; ++before) {
            if (files[before] == files[k] || std::filesystem::equivalent(files[before], files[k], missing))
                throw InvalidInput({files[k].string() + ": is given twice; name each log once"});
        }
    }
}

}  // namespace

std::string file_names(const std::vector<std::filesystem::path>& files) {
    std::string names;
    for (const auto& file : files) names += (names.empty() ? "" : ", ") + file.filename().string();
    return names;
}

std::vector<std::unique_ptr<logs::Log>> read_logs(const std::vector<std::filesystem::path>& files,
                                                  logs::ReadOptions options,
                                                  const std::function<void(double)>& on_progress) {
    require_each_once(files);
    const auto bytes_of = [](const std::filesystem::path& file) {
        std::error_code failed;
        const auto size = std::filesystem::file_size(file, failed);
        return failed ? 0.0 : static_cast<double>(size);
    };
    double all_bytes = 0.0;
    for (const auto& file : files) all_bytes += bytes_of(file);
    double read_bytes = 0.0;
    options.memory_limit_bytes /= std::max<std::size_t>(files.size(), 1);
    std::vector<std::unique_ptr<logs::Log>> read;
    for (const auto& file : files) {
        const double file_bytes = bytes_of(file);
        if (on_progress && all_bytes > 0.0)
            options.on_progress = [&](double fraction) {
                on_progress((read_bytes + fraction * file_bytes) / all_bytes);
            };
        read.push_back(std::make_unique<logs::Log>(logs::read_log(file, options)));
        read_bytes += file_bytes;
    }
    return read;
}

int find_column(const logs::LogTable& table, const std::string& wanted) {
    const int named = table.column(wanted);
    if (named >= 0) return named;
    if (wanted.empty() || !std::all_of(wanted.begin(), wanted.end(), ::isdigit) || wanted.size() > 4)
        return -1;
    const int number = std::stoi(wanted);
    return number >= 1 && number <= static_cast<int>(table.columns.size()) ? number - 1 : -1;
}

std::vector<std::string> column_names(const logs::Log& log) {
    std::vector<std::string> names;
    for (const logs::LogTable& table : log.tables) {
        for (const logs::LogColumn& column : table.columns) names.push_back(table.name + "\n" + column.name);
    }
    return names;
}

namespace {

// In "tau_m" and "theta_m" the letter stands for the motor: a torque, an angle or a current has no metres.
bool names_the_motor(std::string_view quantity, std::string_view ending) {
    constexpr std::array quantities{"tau",   "torque", "trq", "tq",    "moment",  "theta", "phi",
                                    "alpha", "angle",  "ang", "omega", "current", "i",     "q"};
    std::string word(quantity.substr(quantity.find_last_of("_ ") + 1));
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return ending == "m" && std::find(quantities.begin(), quantities.end(), word) != quantities.end();
}

}  // namespace

std::string stated_unit(const logs::LogColumn& column) {
    if (!column.unit.empty()) return column.unit;
    const std::size_t bar = column.name.find_last_of("_ ");
    if (bar == std::string::npos) return "";
    const std::string ending = column.name.substr(bar + 1);
    if (names_the_motor(std::string_view(column.name).substr(0, bar), ending)) return "";
    return find_unit(ending) ? ending : "";
}

}  // namespace capstan::imports
