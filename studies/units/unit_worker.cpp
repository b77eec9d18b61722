#include "capstan/units/unit_worker.h"

#include <set>
#include <stdexcept>

#include "capstan/units/lease.h"
#include "capstan/units/unit_record.h"

namespace capstan::units {

namespace {

class Worker {
  public:
    Worker(SharedFolder& folder, UnitWork& work, const WorkerOptions& options)
        : folder_(folder), work_(work), options_(options) {}

    WorkEnd run(std::optional<int> own) {
        if (work_.is_merged()) return WorkEnd::complete;
        if (own && !is_done(*own)) {
            const Lease lease = Lease::take(folder_, lease_of(*own));
            compute(*own, lease, false);
        }
        while (!own && !work_.stop_requested() && compute_a_free_unit()) continue;
        while (!work_.stop_requested() && stand_by()) continue;
        if (work_.stop_requested()) return WorkEnd::stopped;
        const auto left = running();
        if (left && left->empty() && !work_.is_merged()) return merge();
        return failed_.empty() ? WorkEnd::complete : WorkEnd::failed;
    }

    WorkEnd merge() {
        constexpr double look_every_s = 0.5;
        while (!work_.is_merged()) {
            if (work_.stop_requested()) return WorkEnd::stopped;
            if (const auto lease = Lease::claim(folder_, merge_lease)) {
                if (work_.is_merged()) break;
                return merge_under_lease();
            }
            folder_.pause(look_every_s);
        }
        return WorkEnd::complete;
    }

  private:
    bool is_done(int unit) {
        if (read_unit_record(folder_, unit)) return true;
        return !is_held(folder_, lease_of(unit), folder_.now_s()) && work_.is_complete_by_hand(unit);
    }

    // Those that run; nothing if some unit is neither done nor begun.
    std::optional<std::vector<int>> running() {
        const LeaseFolder leases = look_at_leases(folder_);
        const double now_s = folder_.now_s();
        std::vector<int> units;
        for (int unit = 1; unit <= work_.count(); ++unit) {
            if (leases.done.count(unit) != 0) continue;
            if (leases.leased.count(unit) != 0 && is_held(folder_, lease_of(unit), now_s))
                units.push_back(unit);
            else if (!is_done(unit))
                return std::nullopt;
        }
        return units;
    }

    // False: there is none.
    bool compute_a_free_unit() {
        const LeaseFolder leases = look_at_leases(folder_);
        for (int unit = 1; unit <= work_.count(); ++unit) {
            if (leases.done.count(unit) != 0 || failed_.count(unit) != 0) continue;
            const std::optional<Lease> lease = Lease::claim(folder_, lease_of(unit));
            if (!lease) continue;
            compute(unit, *lease, false);
            return true;
        }
        return false;
    }

    // Beside a unit that runs, until it is done or this worker has done it. False: nobody is needed.
    bool stand_by() {
        const auto left = running();
        if (!left) return false;  // the scheduler starts the others
        for (const int unit : *left) {
            if (failed_.count(unit) != 0) continue;
            const std::optional<Lease> place = Lease::claim(folder_, standby_of(unit));
            if (!place) continue;
            wait_beside(unit);
            return true;
        }
        return false;
    }

    void wait_beside(int unit) {
        constexpr double look_every_s = 0.5;
        while (!work_.stop_requested() && !read_unit_record(folder_, unit)) {
            const auto lease = read_lease(folder_, lease_of(unit));
            if (!lease || !is_held(folder_, lease_of(unit), folder_.now_s())) {
                if (const auto claimed = Lease::claim(folder_, lease_of(unit)))
                    compute(unit, *claimed, false);
                return;
            }
            if (is_late(folder_, unit, options_.late_after_s, options_.late_factor)) {
                say("Shard " + std::to_string(unit) + " is late at " + lease->worker +
                    "; computing it once more.");
                const Lease own = Lease::take(folder_, second_lease_of(unit));
                compute(unit, own, true);
                return;
            }
            folder_.pause(look_every_s);
        }
    }

    // Nothing if it was done between the look at it and the lease.
    void compute(int unit, const Lease& lease, bool is_second) {
        if (read_unit_record(folder_, unit)) return;
        const UnitWork::Computed done =
            work_.compute(unit, is_second, [&] { return read_unit_record(folder_, unit).has_value(); });
        if (done.end == WorkEnd::complete && !read_unit_record(folder_, unit)) {
            const double seconds = folder_.now_s() - lease.begun_s();
            write_unit_record(folder_, unit,
                              {folder_.worker(), seconds, done.file, done.sha256, done.computed_with});
            say("shard " + std::to_string(unit) + " of " + std::to_string(work_.count()) + " is done.");
        } else if (is_second) {
            work_.discard(done.file);  // the other worker was faster
        }
        if (done.end == WorkEnd::failed) failed_.insert(unit);
    }

    WorkEnd merge_under_lease() {
        constexpr int rounds = 3;
        for (int round = 0; round < rounds; ++round) {
            const UnitWork::Merged merged = work_.merge();
            if (merged.damaged.empty()) return merged.end;
            for (const int unit : merged.damaged) {
                say("The result of shard " + std::to_string(unit) + " is damaged; computing it again.");
                folder_.remove(done_file_of(unit));
                const Lease lease = Lease::take(folder_, lease_of(unit));
                compute(unit, lease, false);
                if (work_.stop_requested()) return WorkEnd::stopped;
            }
        }
        throw std::runtime_error(
            "results stay damaged however often they are computed; is the disk in order?");
    }

    void say(const std::string& text) const {
        if (options_.say) options_.say(text);
    }

    SharedFolder& folder_;
    UnitWork& work_;
    const WorkerOptions& options_;
    std::set<int> failed_;  // here
};

}  // namespace

WorkEnd work(SharedFolder& folder, UnitWork& work, std::optional<int> own, const WorkerOptions& options) {
    return Worker(folder, work, options).run(own);
}

WorkEnd merge(SharedFolder& folder, UnitWork& work, const WorkerOptions& options) {
    return Worker(folder, work, options).merge();
}

}  // namespace capstan::units
