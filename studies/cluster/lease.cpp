#include "capstan/cluster/lease.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "capstan/platform/files.h"

namespace capstan::cluster {

namespace fs = std::filesystem;

namespace {

std::optional<double> modification_time_s(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return static_cast<double>(status.st_mtim.tv_sec) + 1e-9 * static_cast<double>(status.st_mtim.tv_nsec);
}

// True if this call made the file: of several at once only one does, also on NFS.
bool make_first(const fs::path& file, const std::string& text) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        if (errno == EEXIST) return false;
        throw std::runtime_error("cannot write " + file.string() + ": " +
                                 std::generic_category().message(errno));
    }
    const bool is_written =
        ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    ::close(descriptor);
    if (!is_written) throw std::runtime_error("cannot write " + file.string() + "; is the disk full?");
    return true;
}

// Removes the lease of a dead worker. Between the look at a lease and its removal another worker may have
// taken it over; so it is moved aside first, where nobody else touches it, and put back if it turns out to be
// alive.
void remove_stale(const fs::path& file, double now_s) {
    const fs::path aside = file.string() + ".stale-" + this_worker();
    std::error_code none;
    fs::rename(file, aside, none);
    if (none) return;  // another worker was first
    if (is_held(aside, now_s)) fs::create_hard_link(aside, file, none);
    fs::remove(aside, none);
}

std::string lease_text(double begun_s) {
    std::ostringstream text;
    text.precision(17);
    text << this_worker() << ' ' << begun_s << '\n';
    return text.str();
}

}  // namespace

double disk_time_s(const fs::path& folder) {
    const fs::path probe = folder / (".clock-" + this_worker());
    std::ofstream(probe) << "now\n";
    const auto time_s = modification_time_s(probe);
    std::error_code none;
    fs::remove(probe, none);
    if (time_s) return *time_s;
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string this_worker() {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
    return std::string(host.data()) + "-" + std::to_string(::getpid());
}

std::optional<LeaseRecord> read_lease(const fs::path& file) {
    std::ifstream stream(file);
    LeaseRecord record;
    if (!(stream >> record.worker >> record.begun_s)) return std::nullopt;
    const auto beat_s = modification_time_s(file);
    if (!beat_s) return std::nullopt;
    record.last_beat_s = *beat_s;
    return record;
}

bool is_held(const fs::path& file, double now_s) {
    const auto beat_s = modification_time_s(file);
    return beat_s && now_s - *beat_s < Lease::stale_after_s;
}

std::optional<Lease> Lease::claim(const fs::path& file) {
    const double now_s = disk_time_s(file.parent_path());
    for (int attempt = 0; attempt < 2; ++attempt) {
        if (make_first(file, lease_text(now_s))) return Lease(file, now_s);
        if (is_held(file, now_s)) return std::nullopt;
        remove_stale(file, now_s);
    }
    return std::nullopt;
}

Lease Lease::take(const fs::path& file) {
    const double now_s = disk_time_s(file.parent_path());
    write_file(file, lease_text(now_s));
    return {file, now_s};
}

Lease::Lease(fs::path file, double begun_s)
    : file_(std::move(file)), begun_s_(begun_s), ends_(std::make_shared<std::atomic<bool>>(false)) {
    heart_ = std::thread([path = file_, ends = ends_] {
        constexpr int beat_every = 50;  // tenths of a second
        for (int tenths = 1; !ends->load(); ++tenths) {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            if (tenths % beat_every == 0) ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
        }
    });
}

Lease::Lease(Lease&& other) noexcept
    : file_(std::move(other.file_)),
      begun_s_(other.begun_s_),
      ends_(std::move(other.ends_)),
      heart_(std::move(other.heart_)) {
    other.file_.clear();
}

Lease::~Lease() {
    if (file_.empty()) return;
    ends_->store(true);
    heart_.join();
    const auto record = read_lease(file_);
    std::error_code none;
    if (record && record->worker == this_worker()) fs::remove(file_, none);
}

}  // namespace capstan::cluster
