#include "capstan/service/job_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "capstan/platform/files.h"

namespace capstan::service {

JobFolder::JobFolder(std::filesystem::path path) : path_(std::move(path)) {
    std::filesystem::create_directories(path_);
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all);
    const std::filesystem::path lock = path_ / "lock";
    lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (lock_ < 0)
        throw std::runtime_error(fmt::format("cannot write {}: {}", lock.string(), std::strerror(errno)));
    if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(lock_);
    throw std::runtime_error(
        fmt::format("another `capstan serve` has {}; use that one, or end it first", path_.string()));
}

JobFolder::~JobFolder() {
    ::close(lock_);
}

std::uintmax_t JobFolder::bytes() const {
    std::uintmax_t bytes = 0;
    std::error_code gone;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path_, gone))
        if (const auto size = entry.is_regular_file(gone) ? entry.file_size(gone) : 0; !gone) bytes += size;
    return bytes;
}

void JobFolder::remove(int job) const {
    std::error_code ignored;
    std::filesystem::remove_all(path_ / std::to_string(job), ignored);
}

std::optional<std::filesystem::file_time_type> JobFolder::last_write(int job) const {
    std::error_code absent;
    const auto time = std::filesystem::last_write_time(path_ / std::to_string(job), absent);
    return absent ? std::nullopt : std::optional(time);
}

std::vector<Job> JobFolder::read() const {
    const std::filesystem::path file = path_ / "jobs.json";
    return std::filesystem::exists(file) ? read_jobs(read_file(file)) : std::vector<Job>{};
}

void JobFolder::write(const std::vector<Job>& jobs) const {
    write_file("jobs.json", jobs_text(jobs));
}

void JobFolder::write_file(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    capstan::write_file(path, bytes);
}

}  // namespace capstan::service
