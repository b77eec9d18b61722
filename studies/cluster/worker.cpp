#include "capstan/cluster/worker.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "capstan/cluster/lease.h"
#include "capstan/cluster/shard_record.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/plan_checks.h"
#include "capstan/placement/study_merge.h"
#include "capstan/worlds/world_shard.h"

namespace capstan::cluster {

namespace {

namespace fs = std::filesystem;

// Sets `stop` when the user asks for it, or when another worker has done the shard.
class Watcher {
  public:
    Watcher(std::atomic<bool>& stop, const std::atomic<bool>* asked, fs::path done_record) {
        thread_ = std::thread([this, &stop, asked, record = std::move(done_record)] {
            for (int tenths = 0; !ends_.load(); ++tenths) {
                std::error_code none;
                if ((asked != nullptr && asked->load()) || (tenths % 20 == 19 && fs::exists(record, none)))
                    stop.store(true);
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
            }
        });
    }
    ~Watcher() {
        ends_.store(true);
        thread_.join();
    }
    Watcher(const Watcher&) = delete;
    Watcher& operator=(const Watcher&) = delete;

  private:
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

void remove_shard(const fs::path& path) {
    for (const char* end : {"", "-wal", "-shm", "-journal"}) {
        std::error_code none;
        fs::remove(path.string() + end, none);
    }
}

class Worker {
  public:
    Worker(const StudyDirectory& directory, const WorkOptions& options)
        : directory_(directory),
          options_(options),
          config_(config::read_config(directory.config_file())),
          plans_(config::runnable_studies(config_)) {
        fs::create_directories(directory.leases_folder());
    }

    RunEnd run(std::optional<int> own) {
        if (is_merged()) return RunEnd::complete;
        if (own && !is_done(*own)) {
            const Lease lease = Lease::take(directory_.lease_file(*own));
            run_shard_into(*own, directory_.shard_file(*own), lease);
        }
        while (!own && !stop_requested() && run_a_free_shard()) continue;
        while (!stop_requested() && stand_by()) continue;
        if (stop_requested()) return RunEnd::stopped;
        const auto left = running();
        return left && left->empty() && !is_merged() ? merge(directory_, options_) : RunEnd::complete;
    }

  private:
    bool stop_requested() const { return options_.run.stop != nullptr && options_.run.stop->load(); }
    bool is_merged() const { return fs::exists(directory_.merged_file()); }

    double now_s() const { return disk_time_s(directory_.leases_folder()); }

    // A file that was made by hand has no record.
    bool is_done(int shard) const {
        return read_shard_record(directory_, shard).has_value() ||
               (fs::exists(directory_.shard_file(shard)) && !is_held(directory_.lease_file(shard), now_s()) &&
                progress_of(directory_, shard).is_done());
    }

    // Those that run; nothing if some shard is neither done nor begun.
    std::optional<std::vector<int>> running() const {
        const LeaseFolder leases = look_at_leases(directory_);
        std::vector<int> shards;
        for (int shard = 1; shard <= directory_.shards; ++shard) {
            if (leases.done.count(shard) != 0) continue;
            if (leases.leased.count(shard) != 0 && is_held(directory_.lease_file(shard), now_s()))
                shards.push_back(shard);
            else if (!is_done(shard))
                return std::nullopt;
        }
        return shards;
    }

    // False: there is none.
    bool run_a_free_shard() {
        const LeaseFolder leases = look_at_leases(directory_);
        for (int shard = 1; shard <= directory_.shards; ++shard) {
            if (leases.done.count(shard) != 0) continue;
            const std::optional<Lease> lease = Lease::claim(directory_.lease_file(shard));
            if (!lease || read_shard_record(directory_, shard)) continue;
            run_shard_into(shard, directory_.shard_file(shard), *lease);
            return true;
        }
        return false;
    }

    // Beside a shard that runs, until it is done or this worker has done it. False: nobody is needed.
    bool stand_by() {
        const auto left = running();
        if (!left) return false;  // the scheduler starts the others
        for (const int shard : *left) {
            const std::optional<Lease> place = Lease::claim(directory_.standby_file(shard));
            if (!place) continue;
            wait_beside(shard);
            return true;
        }
        return false;
    }

    void wait_beside(int shard) {
        while (!stop_requested() && !read_shard_record(directory_, shard)) {
            const auto lease = read_lease(directory_.lease_file(shard));
            if (!lease || !is_held(directory_.lease_file(shard), now_s())) {
                if (const auto claimed = Lease::claim(directory_.lease_file(shard)))
                    run_shard_into(shard, directory_.shard_file(shard), *claimed);
                return;
            }
            if (is_late(directory_, shard, options_.late_after_s, options_.late_factor)) {
                say("Shard " + std::to_string(shard) + " is late at " + lease->worker +
                    "; computing it once more.");
                const Lease own = Lease::take(directory_.second_lease_file(shard));
                run_shard_into(shard, directory_.second_file(shard, this_worker()), own);
                return;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
        }
    }

    void run_shard_into(int shard, const fs::path& file, const Lease& lease) {
        std::atomic<bool> stop{false};
        RunEnd end = RunEnd::stopped;
        {
            const Watcher watcher(stop, options_.run.stop, directory_.done_file(shard));
            storage::Database database = storage::Database::open_or_create(file, storage::Journal::rollback);
            end = run_in(database, {shard, directory_.shards}, stop);
        }
        if (end == RunEnd::complete && !read_shard_record(directory_, shard)) {
            const double seconds = disk_time_s(directory_.leases_folder()) - lease.begun_s();
            write_shard_record(directory_, shard, {this_worker(), seconds, file.filename().string()});
            say(words_of({shard, directory_.shards}) + " is done.");
        } else if (file != directory_.shard_file(shard)) {
            remove_shard(file);  // the other worker was faster
        }
    }

    RunEnd run_in(storage::Database& database, const Shard& shard, const std::atomic<bool>& stop) {
        if (!config_.plan.uncertainty.is_stated) {
            RunOptions options = options_.run;
            options.stop = &stop;
            return run_shard(database, plans_, shard, options_.program_version, options).end;
        }
        TableOptions options;
        options.jobs = options_.run.jobs;
        options.stop = &stop;
        try {
            run_world_shard(database, plans_.front(), {shard.number, shard.count}, options_.program_version,
                            options);
        } catch (const TableStopped&) {
            return RunEnd::stopped;
        }
        return RunEnd::complete;
    }

    void say(const std::string& text) const {
        if (options_.say) options_.say(text);
    }

    const StudyDirectory& directory_;
    const WorkOptions& options_;
    config::ReadConfig config_;
    std::vector<StudyPlan> plans_;
};

RunEnd merge_files(const StudyDirectory& directory, const WorkOptions& options) {
    std::vector<fs::path> files;
    for (int shard = 1; shard <= directory.shards; ++shard) files.push_back(file_of_shard(directory, shard));
    const config::ReadConfig config = config::read_config(directory.config_file());
    if (!config.plan.uncertainty.is_stated) return merge_shards(directory.merged_file(), files, options.run);
    TableOptions of_table;
    of_table.jobs = options.run.jobs;
    of_table.stop = options.run.stop;
    try {
        merge_world_shards(directory.merged_file(), files, of_table);
    } catch (const TableStopped&) {
        return RunEnd::stopped;
    }
    return RunEnd::complete;
}

}  // namespace

RunEnd work(const StudyDirectory& directory, std::optional<int> own, const WorkOptions& options) {
    return Worker(directory, options).run(own);
}

RunEnd merge(const StudyDirectory& directory, const WorkOptions& options) {
    fs::create_directories(directory.leases_folder());
    while (!fs::exists(directory.merged_file())) {
        if (options.run.stop != nullptr && options.run.stop->load()) return RunEnd::stopped;
        if (const auto lease = Lease::claim(directory.merge_lease_file())) {
            if (fs::exists(directory.merged_file())) break;
            const RunEnd end = merge_files(directory, options);
            if (end == RunEnd::complete && options.say)
                options.say("Merged " + std::to_string(directory.shards) + " shards into " +
                            directory.merged_file().string() + ".");
            return end;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
    return RunEnd::complete;
}

}  // namespace capstan::cluster
