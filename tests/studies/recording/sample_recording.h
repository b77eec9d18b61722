#pragma once

#include <filesystem>
#include <string>

#include "capstan/calibration/twin.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// A pull-pull bench's session of two short runs: torque ramps against a locked load, and a handle moved to
/// and fro. Only the driven channels hold anything yet.
Recording driven_session();

/// The same with every other channel as the bench's own model measures it with these parameters (as
/// nominal_values orders them), and noise of the stated size on it.
Recording measured_session(const std::vector<double>& parameters);

/// A recording as its two files, for a test to break.
struct RecordingFiles {
    std::string samples_csv;
    std::string sidecar_json;
};
RecordingFiles as_files(const Recording& recording);

/// A folder of its own for one test, gone with it.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    /// Writes both files under one name; returns the path of the samples.
    std::filesystem::path write(const RecordingFiles& files, const std::string& name = "bench") const;

  private:
    std::filesystem::path path_;
};

}  // namespace capstan::gap
