#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capstan/service/exchange.h"
#include "capstan/service/job_queue.h"

namespace capstan::service {

inline constexpr std::size_t max_uploaded_logs = 32;

/// A temporary folder that only this user can read, and that is gone when this is.
class PrivateFolder {
  public:
    explicit PrivateFolder(const std::string& name);
    ~PrivateFolder();
    PrivateFolder(const PrivateFolder&) = delete;
    PrivateFolder& operator=(const PrivateFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// A private folder with the logs of one request, in which `capstan import` runs as a process of
/// its own: no file can end the service or hold it for long. The folder is gone when this is.
class ImportFolder {
  public:
    /// Takes the parts `log` of the request and, where it has one, the part `mapping`. Throws BadRequest: no
    /// file, too many, two of one name.
    ImportFolder(const http::Request& request, const JobCommands& commands);
    /// What `capstan import LOGS words...` writes on its standard output. Throws BadRequest with its
    /// messages, one a line.
    std::string import(const std::vector<std::string>& words) const;

    /// Imports by the part `mapping`; the path of the recording NAME.csv, in `answer` what was done (JSON).
    std::filesystem::path import_recording(std::string& answer) const;

    /// The name of the first log without its ending.
    std::string name() const { return logs_.front().stem().string(); }

  private:
    std::filesystem::path folder() const { return private_.path(); }

    PrivateFolder private_;
    std::string program_;
    const std::atomic<bool>* ending_;
    std::vector<std::filesystem::path> logs_;
    bool has_mapping_ = false;
};

/// The name of an uploaded file without anything that could lead out of a folder, hide it or stand for other
/// names.
std::string safe_file_name(const std::string& name);

}  // namespace capstan::service
