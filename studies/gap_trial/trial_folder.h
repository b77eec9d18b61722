#pragma once

#include <filesystem>
#include <string>

#include "capstan/gap_trial/trial_plan.h"

namespace capstan::gap_trial {

/// Where a trial keeps what it makes: trial.json (what was asked for), NAME.csv and NAME.json (recordings),
/// labels.json and labels.sha256, answers/ and references/ (one file a case, so that a trial that was killed
/// goes on where it was).
class TrialFolder {
  public:
    /// A folder to keep. Throws InvalidInput if a trial with other options is in it already.
    static TrialFolder kept(const std::filesystem::path& path, const TrialOptions& options);
    /// A folder of its own that goes with the object.
    static TrialFolder temporary(const TrialOptions& options);
    /// The folder of a trial that labels belong to, as it is.
    static TrialFolder of_labels(const std::filesystem::path& labels_file);

    TrialFolder(TrialFolder&& other) noexcept;
    TrialFolder(const TrialFolder&) = delete;
    TrialFolder& operator=(const TrialFolder&) = delete;
    ~TrialFolder();

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path recording(const std::string& name) const { return path_ / (name + ".csv"); }
    std::filesystem::path answer(const std::string& name) const;
    std::filesystem::path reference(const std::string& name) const;
    std::filesystem::path labels() const { return path_ / "labels.json"; }
    /// What labels.sha256 says; empty if nothing has been sealed yet.
    std::string seal() const;

  private:
    TrialFolder(std::filesystem::path path, bool goes_away);
    void state_options(const TrialOptions& options) const;

    std::filesystem::path path_;
    bool goes_away_ = false;
};

}  // namespace capstan::gap_trial
