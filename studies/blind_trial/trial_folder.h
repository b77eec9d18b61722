#pragma once

#include <filesystem>
#include <string>

#include "capstan/gap_trial/trial_plan.h"

namespace capstan::gap_trial {

/// The files of a trial: trial.json (its options), NAME.csv and NAME.json (recordings),
/// labels.json and labels.sha256, answers/ and references/ (one file for each case, so that a killed trial
/// continues where it stopped).
class TrialFolder {
  public:
    /// A permanent folder. Throws InvalidInput if it holds a trial with other options.
    static TrialFolder kept(const std::filesystem::path& path, const TrialOptions& options);
    /// A temporary folder, removed with the object.
    static TrialFolder temporary(const TrialOptions& options);
    /// The existing folder of a trial, from its labels.
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
    TrialFolder(std::filesystem::path path, bool is_temporary);
    void state_options(const TrialOptions& options) const;

    std::filesystem::path path_;
    bool is_temporary_ = false;
};

}  // namespace capstan::gap_trial
