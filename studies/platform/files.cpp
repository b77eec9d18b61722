#include "capstan/platform/files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "capstan/platform/standard_streams.h"

namespace capstan {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t pending_bytes = std::size_t{1} << 20;
constexpr std::string_view temporary_prefix = ".capstan-unfinished-";

std::string what_to_try(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
            return "the disk is full; free some space, or name a file on another disk";
        case EFBIG:
            return "it would be larger than a file may be here; see `ulimit -f`";
        case EACCES:
        case EPERM:
        case EROFS:
            return "you may not write there; change the permission, or name a file in a folder of yours";
        case ENOENT:
        case ENOTDIR:
            return "its folder does not exist; make it, or name a file elsewhere";
        case EISDIR:
            return "it is a folder; name a file in it";
        default:
            return std::strerror(error);
    }
}

[[noreturn]] void refuse(const fs::path& path, int error) {
    throw std::runtime_error("cannot write " + path.string() + ": " + what_to_try(error));
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// A name beside `path` that no other process or thread chooses.
std::string temporary_name(const fs::path& path) {
    std::uint64_t bits = 0;
    if (::getrandom(&bits, sizeof bits, 0) != sizeof bits) refuse(path, errno);
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(bits));
    return (folder_of(path) / (std::string(temporary_prefix) + digits)).string();
}

/// Every writer locks its file, so a temporary file that can be locked belongs to a process that has died.
void remove_stale_temporaries(const fs::path& folder) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        if (!entry.path().filename().string().starts_with(temporary_prefix)) continue;
        const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
        if (descriptor < 0) continue;
        if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(entry.path().c_str());
        ::close(descriptor);
    }
}

/// A file without a name, which vanishes with its writer. -1 where the file system has none, or where such a
/// file could not be given a name later.
int open_nameless(const fs::path& path) {
    if (::access("/proc/self/fd", X_OK) != 0) return -1;
    const int descriptor = ::open(folder_of(path).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
    if (descriptor >= 0) ::flock(descriptor, LOCK_EX);
    return descriptor;
}

/// For the other file systems. Repeats if another process took the file for a stale one before it was locked.
int open_temporary(const fs::path& path, std::string& name) {
    remove_stale_temporaries(folder_of(path));
    for (;;) {
        name = temporary_name(path);
        const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0) return -1;
        struct stat status = {};
        if (::flock(descriptor, LOCK_EX) != 0 || ::fstat(descriptor, &status) != 0 || status.st_nlink > 0)
            return descriptor;
        ::close(descriptor);
    }
}

/// The owner stays too where this user may set it.
void keep_mode(int descriptor, const fs::path& path) {
    struct stat status = {};
    if (::stat(path.c_str(), &status) != 0) return;
    if (::fchown(descriptor, status.st_uid, status.st_gid) != 0) errno = 0;
    if (::fchmod(descriptor, status.st_mode & 07777) != 0) refuse(path, errno);
}

bool sync_path(const fs::path& path, int flags) {
    const int descriptor = ::open(path.c_str(), flags | O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return errno == EACCES;  // a folder that may be written but not listed
    const bool synced = ::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP;
    const int error = errno;
    ::close(descriptor);
    errno = error;
    return synced;
}

void sync_folder_of(const fs::path& path) {
    if (!sync_path(folder_of(path), O_DIRECTORY)) refuse(path, errno);
}

}  // namespace

std::string read_file(const fs::path& path) {
    const auto fail = [&](int error) {
        throw std::runtime_error(
            "cannot read " + path.string() + ": " +
            (error == EACCES ? "you may not read it; check its permissions" : std::strerror(error)));
    };
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) fail(errno);
    std::string text;
    ssize_t count = 0;
    try {
        struct stat status = {};
        if (::fstat(descriptor, &status) == 0 && status.st_size > 0)
            text.reserve(static_cast<std::size_t>(status.st_size));
        char bytes[1 << 16];
        while ((count = ::read(descriptor, bytes, sizeof bytes)) > 0 || (count < 0 && errno == EINTR)) {
            if (count > 0) text.append(bytes, static_cast<std::size_t>(count));
        }
    } catch (...) {
        ::close(descriptor);
        throw;
    }
    const int error = errno;
    ::close(descriptor);
    if (count < 0) fail(error);
    return text;
}

void require_writable(const fs::path& path) {
    struct stat status = {};
    const bool exists = ::stat(path.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) refuse(path, EISDIR);
    if (exists && !S_ISREG(status.st_mode)) {
        if (::access(path.c_str(), W_OK) != 0) refuse(path, errno);
        return;
    }
    const fs::path folder = folder_of(exists ? fs::canonical(path) : path);
    if (::stat(folder.c_str(), &status) != 0) refuse(path, errno);
    if (!S_ISDIR(status.st_mode)) refuse(path, ENOTDIR);
    if (::access(folder.c_str(), W_OK | X_OK) != 0) refuse(path, errno);
}

void write_file(const fs::path& path, std::string_view text) {
    AtomicFile file(path);
    file.append(text);
    file.finish();
}

AtomicFile::AtomicFile(const fs::path& path) : named_(path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) refuse(path, EISDIR);
    path_ = fs::is_symlink(path, ignored) ? fs::weakly_canonical(path, ignored) : path;
    is_special_ = fs::exists(path, ignored) && !fs::is_regular_file(path, ignored);
    if (is_special_) {
        descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
        descriptor_ = open_nameless(path_);
        if (descriptor_ < 0) descriptor_ = open_temporary(path_, temporary_);
    }
    if (descriptor_ < 0) refuse(named_, errno);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0 && !temporary_.empty()) ::unlink(temporary_.c_str());
    if (descriptor_ >= 0) ::close(descriptor_);
}

void AtomicFile::write_pending() {
    if (!write_all(descriptor_, pending_)) refuse(named_, errno);
    pending_.clear();
}

void AtomicFile::append(std::string_view text) {
    if (text.size() >= pending_bytes) {
        write_pending();
        if (!write_all(descriptor_, text)) refuse(named_, errno);
        return;
    }
    pending_ += text;
    if (pending_.size() >= pending_bytes) write_pending();
}

// A file without a name gets the final one where that is free. Only a rename replaces what has it already.
void AtomicFile::publish() {
    if (temporary_.empty()) {
        const std::string self = "/proc/self/fd/" + std::to_string(descriptor_);
        if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, path_.c_str(), AT_SYMLINK_FOLLOW) == 0) return;
        if (errno != EEXIST) refuse(named_, errno);
        remove_stale_temporaries(folder_of(path_));
        std::string name = temporary_name(path_);
        if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0)
            refuse(named_, errno);
        temporary_ = std::move(name);
    }
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) refuse(named_, errno);
    temporary_.clear();
}

void AtomicFile::finish() {
    write_pending();
    if (!is_special_) {
        keep_mode(descriptor_, path_);
        if (::fsync(descriptor_) != 0) refuse(named_, errno);
        publish();
    }
    if (::close(std::exchange(descriptor_, -1)) != 0) refuse(named_, errno);
    if (!is_special_) sync_folder_of(path_);
}

void rename_durably(const fs::path& from, const fs::path& to) {
    if (!sync_path(from, 0)) refuse(from, errno);
    if (::rename(from.c_str(), to.c_str()) != 0) refuse(to, errno);
    sync_folder_of(to);
}

}  // namespace capstan
