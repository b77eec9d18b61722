#include "capstan/units/lease.h"

#include <exception>
#include <sstream>

namespace capstan::units {

namespace {

std::string lease_text(const SharedFolder& folder, double begun_s) {
    std::ostringstream text;
    text.precision(17);
    text << folder.worker() << ' ' << begun_s << '\n';
    return text.str();
}

// Removes the lease of a dead worker. Only the worker that has made "<name>.takeover" may: one that saw the
// dead worker's lease long ago would otherwise remove that of a worker which has taken it over since. The
// lock of a worker that dies here gets stale as a lease does. Where the disk shows an old time, as NFS may,
// the lease is seen to be alive once it is moved aside; it is put back then.
void remove_stale(SharedFolder& folder, const std::string& name, double now_s) {
    const std::string lock = name + ".takeover";
    if (!folder.create(lock, lease_text(folder, now_s))) {
        if (!is_held(folder, lock, now_s)) folder.remove(lock);
        return;
    }
    const std::string aside = name + ".stale-" + folder.worker();
    if (!is_held(folder, name, now_s) && folder.rename(name, aside)) {
        if (is_held(folder, aside, now_s)) folder.link(aside, name);
        folder.remove(aside);
    }
    folder.remove(lock);
}

}  // namespace

std::optional<LeaseRecord> read_lease(SharedFolder& folder, const std::string& name) {
    std::istringstream text(folder.read(name).value_or(""));
    LeaseRecord record;
    if (!(text >> record.worker >> record.begun_s)) return std::nullopt;
    const auto beat_s = folder.modified_s(name);
    if (!beat_s) return std::nullopt;
    record.last_beat_s = *beat_s;
    return record;
}

bool is_held(SharedFolder& folder, const std::string& name, double now_s) {
    const auto beat_s = folder.modified_s(name);
    return beat_s && now_s - *beat_s < Lease::stale_after_s;
}

std::optional<Lease> Lease::claim(SharedFolder& folder, const std::string& name) {
    const double now_s = folder.now_s();
    for (int attempt = 0; attempt < 3; ++attempt) {  // a dead worker may have left a lock and a lease
        if (folder.create(name, lease_text(folder, now_s))) return Lease(folder, name, now_s);
        if (is_held(folder, name, now_s)) return std::nullopt;
        remove_stale(folder, name, now_s);
    }
    return std::nullopt;
}

Lease Lease::take(SharedFolder& folder, const std::string& name) {
    const double now_s = folder.now_s();
    folder.replace(name, lease_text(folder, now_s));
    return {folder, name, now_s};
}

Lease::Lease(SharedFolder& folder, std::string name, double begun_s)
    : folder_(&folder), name_(std::move(name)), begun_s_(begun_s), heart_(folder.beat(name_)) {}

Lease::Lease(Lease&& other) noexcept
    : folder_(other.folder_),
      name_(std::move(other.name_)),
      begun_s_(other.begun_s_),
      heart_(std::move(other.heart_)) {
    other.name_.clear();
}

Lease::~Lease() {
    if (name_.empty()) return;
    heart_.reset();
    try {
        const auto record = read_lease(*folder_, name_);
        if (record && record->worker == folder_->worker()) folder_->remove(name_);
    } catch (const std::exception&) {  // the disk fails: the lease gets stale
    }
}

}  // namespace capstan::units
