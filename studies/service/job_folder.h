#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/service/job.h"

namespace capstan::service {

/// Where jobs are kept: a folder beside the database, FILE.jobs, with jobs.json and what each job needs. One
/// service at a time has it, and only its user may look into it.
class JobFolder {
  public:
    /// Makes the folder if it does not exist. Throws std::runtime_error if another service uses it.
    explicit JobFolder(std::filesystem::path path);
    ~JobFolder();
    JobFolder(const JobFolder&) = delete;
    JobFolder& operator=(const JobFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// Of all files in it.
    std::uintmax_t bytes() const;
    /// What a job was given and wrote; nothing if that is gone already.
    void remove(int job) const;
    /// When the files of a job were last written; nothing if it has none.
    std::optional<std::filesystem::file_time_type> last_write(int job) const;

    std::vector<Job> read() const;  ///< none in a new folder
    /// Complete or not at all, and on the disk when it returns.
    void write(const std::vector<Job>& jobs) const;
    void write_file(const std::string& name, std::string_view bytes) const;

  private:
    std::filesystem::path path_;
    int lock_ = -1;
};

}  // namespace capstan::service
