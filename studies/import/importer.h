#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "capstan/import/finding.h"
#include "capstan/import/mapping.h"
#include "capstan/recording/recording.h"

namespace capstan::imports {

struct ImportOptions {
    /// Repair nothing: the import is refused where the recording would differ from the log.
    bool strict = false;
    std::function<void(const std::string& activity, double fraction)> on_progress{};
};

/// One run of the recording and where it comes from.
struct ImportedRun {
    int number = 0;
    std::string source;  ///< files, and the stretch of them
    std::size_t samples = 0;
    double duration_s = 0.0;
};

/// What an import did.
struct ImportReport {
    std::vector<std::string> files;
    std::vector<Finding> findings;
    std::vector<ImportedRun> runs;
    std::vector<std::string> channels;
    double sample_rate_Hz = 0.0;
    Recording recording;  ///< at most `preview_samples` samples of each run, for figures and checks
};

inline constexpr std::size_t preview_samples = 20000;

/// Reads logs by a mapping and writes the recording NAME.csv with NAME.json. The same files and mapping give
/// the same bytes. Nothing is written where the mapping does not fit, the recording would be refused by its
/// reader, or `strict` is asked for and something would be repaired; then InvalidInput says all of it.
ImportReport import_logs(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                         const std::filesystem::path& name, const ImportOptions& options = {});

/// The same without writing anything, for looking at it first.
ImportReport try_import(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                        const ImportOptions& options = {});

}  // namespace capstan::imports
