#include "capstan/service/job_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace capstan::service {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path) {
    throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
}

}  // namespace

JobFolder::JobFolder(std::filesystem::path path) : path_(std::move(path)) {
    std::filesystem::create_directories(path_);
    const std::filesystem::path lock = path_ / "lock";
    lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (lock_ < 0) refuse(lock);
    if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(lock_);
    throw std::runtime_error(
        fmt::format("another `capstan serve` has {}; use that one, or end it first", path_.string()));
}

JobFolder::~JobFolder() {
    ::close(lock_);
}

std::vector<Job> JobFolder::read() const {
    std::ifstream file(path_ / "jobs.json", std::ios::binary);
    if (!file) return {};
    return read_jobs({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
}

void JobFolder::write(const std::vector<Job>& jobs) const {
    write_file("jobs.json", jobs_text(jobs));
}

void JobFolder::write_file(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    const std::string unfinished = path.string() + ".unfinished";
    std::FILE* file = std::fopen(unfinished.c_str(), "wb");
    if (file == nullptr) refuse(path);
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() &&
                         std::fflush(file) == 0 && ::fsync(::fileno(file)) == 0;
    if (std::fclose(file) != 0 || !written || std::rename(unfinished.c_str(), path.c_str()) != 0)
        refuse(path);
}

}  // namespace capstan::service
