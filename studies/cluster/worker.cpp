#include "capstan/cluster/worker.h"

#include <atomic>
#include <chrono>
#include <thread>

#include "capstan/cluster/batch_work.h"
#include "capstan/cluster/shard_record.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/plan_checks.h"
#include "capstan/placement/study_merge.h"
#include "capstan/units/unit_worker.h"
#include "capstan/worlds/world_shard.h"

namespace capstan::cluster {

namespace fs = std::filesystem;
using units::WorkEnd;

Watcher::Watcher(std::atomic<bool>& stop, const std::atomic<bool>* asked, std::function<bool()> is_unwanted) {
    thread_ = std::thread([this, &stop, asked, unwanted = std::move(is_unwanted)] {
        for (int tenths = 0; !ends_.load(); ++tenths) {
            if ((asked != nullptr && asked->load()) || (tenths % 20 == 19 && unwanted())) stop.store(true);
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
    });
}

Watcher::~Watcher() {
    ends_.store(true);
    thread_.join();
}

namespace {

void remove_shard(const fs::path& path) {
    for (const char* end : {"", "-wal", "-shm", "-journal"}) {
        std::error_code none;
        fs::remove(path.string() + end, none);
    }
}

WorkEnd work_end(RunEnd end) {
    return end == RunEnd::stopped ? WorkEnd::stopped : WorkEnd::complete;
}

// Shards of a study, each in a database.
class StudyWork final : public units::UnitWork {
  public:
    StudyWork(const StudyDirectory& directory, const WorkOptions& options)
        : directory_(directory),
          options_(options),
          config_(config::read_config(directory.config_file())),
          plans_(config::runnable_studies(config_)) {}

    int count() const override { return directory_.shards; }
    bool is_merged() override { return fs::exists(directory_.merged_file()); }
    bool stop_requested() const override { return options_.run.stop != nullptr && options_.run.stop->load(); }

    bool is_complete_by_hand(int unit) override {
        return fs::exists(directory_.shard_file(unit)) && progress_of(directory_, unit).is_done();
    }

    Computed compute(int unit, bool is_second, const std::function<bool()>& is_unwanted) override {
        const fs::path file = is_second ? directory_.second_file(unit, directory_.leases().worker())
                                        : directory_.shard_file(unit);
        std::atomic<bool> stop{false};
        const Watcher watcher(stop, options_.run.stop, is_unwanted);
        storage::Database database = storage::Database::open_or_create(file, storage::Journal::rollback);
        return {work_end(run_in(database, {unit, directory_.shards}, stop)), file.filename().string()};
    }

    void discard(const std::string& file) override { remove_shard(directory_.path / file); }

    Merged merge() override {
        units::DiskFolder leases = directory_.leases();
        Merged damaged;
        for (const int shard : units::look_at_leases(leases).done)
            if (!units::read_unit_record(leases, shard) || !fs::exists(file_of_shard(directory_, shard)))
                damaged.damaged.push_back(shard);
        if (!damaged.damaged.empty()) return damaged;
        std::vector<fs::path> files;
        for (int shard = 1; shard <= directory_.shards; ++shard)
            files.push_back(file_of_shard(directory_, shard));
        if (!config_.plan.uncertainty.is_stated)
            return {work_end(merge_shards(directory_.merged_file(), files, options_.run))};
        TableOptions of_table;
        of_table.jobs = options_.run.jobs;
        of_table.stop = options_.run.stop;
        try {
            merge_world_shards(directory_.merged_file(), files, of_table);
        } catch (const TableStopped&) {
            return {WorkEnd::stopped};
        }
        return {WorkEnd::complete};
    }

  private:
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

    const StudyDirectory& directory_;
    const WorkOptions& options_;
    config::ReadConfig config_;
    std::vector<StudyPlan> plans_;
};

// Calls `action` with the folder of leases and what its units are.
WorkEnd with_work(const StudyDirectory& directory, const WorkOptions& options,
                  const std::function<WorkEnd(units::SharedFolder&, units::UnitWork&)>& action) {
    fs::create_directories(directory.leases_folder());
    units::DiskFolder leases = directory.leases();
    if (directory.batch) {
        units::DiskFolder results(directory.path);
        units::ResultWork work(
            leases, results, units_of(directory),
            [&](int unit, const std::function<bool()>& is_unwanted) {
                return run_unit(directory, unit, options, is_unwanted);
            },
            [&] { return options.run.stop != nullptr && options.run.stop->load(); });
        return action(leases, work);
    }
    StudyWork work(directory, options);
    return action(leases, work);
}

units::WorkerOptions worker_options(const WorkOptions& options) {
    return {options.late_after_s, options.late_factor, options.say};
}

}  // namespace

WorkEnd work(const StudyDirectory& directory, std::optional<int> own, const WorkOptions& options) {
    return with_work(directory, options, [&](units::SharedFolder& leases, units::UnitWork& work) {
        return units::work(leases, work, own, worker_options(options));
    });
}

WorkEnd merge(const StudyDirectory& directory, const WorkOptions& options) {
    return with_work(directory, options, [&](units::SharedFolder& leases, units::UnitWork& work) {
        return units::merge(leases, work, worker_options(options));
    });
}

}  // namespace capstan::cluster
