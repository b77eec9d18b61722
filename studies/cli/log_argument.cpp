#include "capstan/cli/log_argument.h"

namespace capstan::cli {

const Argument log_argument{
    "LOG",
    "A recording: NAME.csv and, beside it, NAME.json, which describes the columns; either name "
    "can be given."};

bool names_a_recording(const std::filesystem::path& path) {
    return path.extension() == ".csv" || path.extension() == ".json";
}

}  // namespace capstan::cli
