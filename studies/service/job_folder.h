#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/service/job.h"

namespace capstan::service {

/// Where jobs are kept: a folder beside the database, FILE.jobs, with jobs.json and what each job needs. One
/// service at a time has it.
class JobFolder {
  public:
    /// Makes the folder if it does not exist. Throws std::runtime_error if another service uses it.
    explicit JobFolder(std::filesystem::path path);
    ~JobFolder();
    JobFolder(const JobFolder&) = delete;
    JobFolder& operator=(const JobFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    std::vector<Job> read() const;  ///< none in a new folder
    /// Complete or not at all, and on the disk when it returns.
    void write(const std::vector<Job>& jobs) const;
    void write_file(const std::string& name, std::string_view bytes) const;

  private:
    std::filesystem::path path_;
    int lock_ = -1;
};

}  // namespace capstan::service
