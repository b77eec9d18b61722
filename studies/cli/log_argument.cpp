#include "capstan/cli/log_argument.h"

namespace capstan::cli {

const Argument log_argument{
    "LOG",
    "A recording: NAME.csv with NAME.json beside it, which says what the columns are; either name is taken."};

bool names_a_recording(const std::filesystem::path& path) {
    return path.extension() == ".csv" || path.extension() == ".json";
}

}  // namespace capstan::cli
