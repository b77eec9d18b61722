#include <algorithm>
#include <stdexcept>
#include <string>

#include "capstan/reports/embedded_files.h"

namespace capstan::reports {

std::string_view embedded_file(std::string_view name) {
    const auto& files = embedded_files();
    const auto found =
        std::find_if(files.begin(), files.end(), [&](const auto& file) { return file.name == name; });
    if (found == files.end())
        throw std::logic_error("No file '" + std::string(name) + "' was built into the program.");
    return found->text;
}

}  // namespace capstan::reports
