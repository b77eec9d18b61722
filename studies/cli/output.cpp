#include "capstan/cli/output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "capstan/cli/usage_error.h"
#include "capstan/cli/whole_file.h"

namespace capstan::cli {

namespace {

std::string what_to_try(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
            return "the disk is full; free some space, or name a file on another disk";
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

[[noreturn]] void refuse(const std::string& name, int error) {
    throw std::runtime_error(fmt::format("cannot write {}: {}", name, what_to_try(error)));
}

bool write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

// Pipes, terminals and the like cannot be renamed over.
bool is_special(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored) &&
           !std::filesystem::is_directory(path, ignored);
}

constexpr std::size_t piece_bytes = 1 << 20;

}  // namespace

void write_standard_output(std::string_view text) {
    std::fflush(stdout);
    if (!write_all(STDOUT_FILENO, text)) refuse("to standard output", errno);
}

WholeFile::WholeFile(const std::filesystem::path& named) : named_(named) {
    std::error_code ignored;
    if (std::filesystem::is_directory(named, ignored)) refuse(named.string(), EISDIR);
    // A link keeps pointing where it does: what it names is replaced.
    path_ = std::filesystem::is_symlink(named, ignored) ? std::filesystem::weakly_canonical(named, ignored)
                                                        : named;
    if (is_special(named)) {
        descriptor_ = ::open(named.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
        temporary_ = fmt::format("{}.part-{}", path_.string(), ::getpid());
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (descriptor_ < 0) {
        temporary_.clear();
        refuse(named.string(), errno);
    }
}

WholeFile::~WholeFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void WholeFile::write_pieces() {
    if (!write_all(descriptor_, pieces_)) refuse(named_.string(), errno);
    pieces_.clear();
}

void WholeFile::append(std::string_view text) {
    pieces_ += text;
    if (pieces_.size() >= piece_bytes) write_pieces();
}

void WholeFile::finish() {
    write_pieces();
    const bool renamed = !temporary_.empty();
    if (renamed && ::fsync(descriptor_) != 0) refuse(named_.string(), errno);
    if (::close(std::exchange(descriptor_, -1)) != 0) refuse(named_.string(), errno);
    if (renamed && ::rename(temporary_.c_str(), path_.c_str()) != 0) refuse(named_.string(), errno);
    temporary_.clear();
}

void write_file(const std::filesystem::path& path, std::string_view text) {
    WholeFile file(path);
    file.append(text);
    file.finish();
}

void deliver(const Invocation& invocation, std::string_view text) {
    const std::string& file = invocation.text("output");
    if (file == "-") return write_standard_output(text);
    write_file(file, text);
}

void deliver_page(const Invocation& invocation, const std::function<std::string()>& page) {
    if (!invocation.has("html")) return;
    const std::string& file = invocation.text("html");
    if (file == "-") {
        throw UsageError(
            "--html -: standard output is taken by the answer in words or CSV; name a file, as page.html");
    }
    write_file(file, page());
    fmt::print(stderr, "Wrote {}.\n", file);
}

}  // namespace capstan::cli
