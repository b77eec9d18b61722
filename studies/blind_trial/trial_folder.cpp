#include "capstan/blind_trial/trial_folder.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "capstan/blind_trial/sealed_labels.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/platform/files.h"

namespace capstan::gap_trial {

TrialFolder::TrialFolder(std::filesystem::path path, bool is_temporary)
    : path_(std::move(path)), is_temporary_(is_temporary) {}

TrialFolder::TrialFolder(TrialFolder&& other) noexcept
    : path_(std::move(other.path_)), is_temporary_(std::exchange(other.is_temporary_, false)) {}

TrialFolder::~TrialFolder() {
    if (!is_temporary_) return;
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

TrialFolder TrialFolder::kept(const std::filesystem::path& path, const TrialOptions& options) {
    TrialFolder folder(path, false);
    folder.state_options(options);
    return folder;
}

TrialFolder TrialFolder::temporary(const TrialOptions& options) {
    TrialFolder folder(std::filesystem::temp_directory_path() / ("capstan-gap-trial-" + random_salt()), true);
    folder.state_options(options);
    return folder;
}

TrialFolder TrialFolder::of_labels(const std::filesystem::path& labels_file) {
    return {labels_file.has_parent_path() ? labels_file.parent_path() : std::filesystem::path("."), false};
}

void TrialFolder::state_options(const TrialOptions& options) const {
    std::filesystem::create_directories(path_ / "answers");
    std::filesystem::create_directories(path_ / "references");
    const std::filesystem::path stated = path_ / "trial.json";
    const std::string text = options_text(options);
    if (!std::filesystem::exists(stated)) {
        write_file(stated, text);
    } else if (read_file(stated) != text) {
        throw InvalidInput(
            {fmt::format("{}: the folder holds a trial with other options:\n{}not\n{}give the same "
                         "options, or another folder",
                         path_.string(), read_file(stated), text)});
    }
}

std::filesystem::path TrialFolder::answer(const std::string& name) const {
    return path_ / "answers" / (name + ".json");
}

std::filesystem::path TrialFolder::reference(const std::string& name) const {
    return path_ / "references" / (name + ".json");
}

std::string TrialFolder::seal() const {
    const std::filesystem::path file = path_ / "labels.sha256";
    if (!std::filesystem::exists(file)) return "";
    const std::string text = read_file(file);
    return text.substr(0, text.find(' '));
}

}  // namespace capstan::gap_trial
