
#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "capstan/cluster/submission.h"
#include "capstan/cluster/worker.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"
#include "capstan/reports/page_frame.h"
#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/study_store.h"
#include "simulated_machine.h"
#include "stored_results.h"

namespace capstan::faults {

namespace fs = std::filesystem;

namespace {

constexpr const char* small_study = R"(
name = "small"
repetitions = 3
[transmission]
segments = 3
axial_stiffness_N = 2000
dynamic_friction = 0.2
static_friction = 0.3
pretension_N = 10
[[transmission.curvature]]
length_m = 0.3
bend_radius_m = 0.2
[motion]
sample_rate_Hz = 100
samples = 50
[motion.proximal]
amplitude_m = 0.003
frequency_Hz = 1
[[regime]]
name = "mass"
samples = [4, 6, 45]
duty_fraction = 1
[[noise]]
label = "5 %"
multiplicative_ratio = 0.05
[[noise]]
label = "0.2 N"
additive_N = 0.2
[layouts]
counts = [1, 2]
)";

void write_text(const fs::path& path, const std::string& text) {
    std::ofstream(path) << text;
}

class StudyRun {
  public:
    StudyRun(std::uint64_t seed, const Reference& reference, const fs::path& folder)
        : machine_(seed, folder), draws_(machine_.draws), reference_(reference) {
        directory_.path = machine_.root / "study";
        directory_.name = "small";
        directory_.shards = 1 + draws_.below(4);
        directory_.scheduler = "snakemake";
        late_after_s_ = draws_.one_in(2) ? 0.0 : 1e6;
        // From its first write to the merge a worker has some hundred operations.
        operations_ = draws_.one_in(2) ? 60 : 600;
        rounds_ = draws_.below(12);
        machine_.run.kind = std::to_string(directory_.shards) + " shards, " + std::to_string(rounds_) +
                            " rounds with faults" + (late_after_s_ > 0.0 ? "" : ", every shard late");
    }

    SystemRun run() {
        cluster::Request request;
        request.directory = directory_;
        cluster::write_folder(request, reference_.config_toml);
        machine_.sync_all();
        for (int round = 0; round < rounds_ && !has_problem(); ++round) one_round();
        finish();
        if (!has_problem()) judge();
        while (machine_.has_halted()) machine_.kill_one();
        return machine_.run;
    }

  private:
    bool has_problem() const { return !machine_.run.problem.empty(); }
    void say(const std::string& problem) {
        if (!has_problem()) machine_.run.problem = problem;
    }
    bool is_merged() const { return fs::exists(directory_.merged_file()); }

    std::function<void()> worker(std::optional<int> own) {
        return [this, own] {
            cluster::WorkOptions options;
            options.run.jobs = 1;
            options.program_version = reports::program_version();
            options.late_after_s = late_after_s_;
            options.late_factor = 0.0;
            if (cluster::work(directory_, own, options) == units::WorkEnd::failed)
                throw std::runtime_error("a shard failed");
        };
    }

    void one_round() {
        Ended ended;
        switch (draws_.below(machine_.has_halted() ? 8 : 5)) {
            case 0:
                if (draws_.one_in(3)) return machine_.cut_power([](const std::string&) { return true; });
                return age_leases(draws_.one_in(2));
            case 1: {
                const auto files =
                    machine_.files([](const std::string& name) { return name.starts_with("shard-"); });
                if (!files.empty() && !is_merged())
                    machine_.flip_a_bit(
                        files[static_cast<std::size_t>(draws_.below(static_cast<int>(files.size())))]);
                return;
            }
            case 5:
            case 6:
                if (machine_.go_on(ended)) obey(ended);
                return;
            case 7:
                return machine_.kill_one();
            default: {
                Planned planned = machine_.some_fault(operations_);
                planned.stops_in_pauses = true;
                std::optional<int> own;
                if (draws_.one_in(2)) own = 1 + draws_.below(directory_.shards);
                if (machine_.start(planned, worker(own), ended)) obey(ended);
            }
        }
    }

    // As if the workers had not been heard of for a while.
    void age_leases(bool all) {
        for (const fs::path& path : machine_.files([](const std::string& name) {
                 return name.ends_with(".lease") || name.ends_with(".standby") || name.ends_with(".second");
             }))
            if (all || draws_.one_in(2))
                fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::seconds(100));
    }

    // What a message says is done: a damaged file of a shard is removed, with the record that it is done.
    bool obey(const Ended& ended) {
        bool did = false;
        for (const fs::path& path :
             machine_.files([](const std::string& name) { return name.ends_with(".db"); })) {
            const std::string name = path.filename().string();
            if (!name.starts_with("shard-") || ended.said.find(name) == std::string::npos) continue;
            for (const char* end : {"", "-journal", "-wal"}) fs::remove(path.string() + end);
            fs::remove(directory_.leases_folder() / (name.substr(0, name.find("-of-")) + ".done"));
            did = true;
        }
        return did;
    }

    void finish() {
        for (int tries = 0; tries < 40 && !has_problem(); ++tries) {
            Ended ended;
            if (machine_.has_halted()) {
                if (machine_.go_on(ended)) obey(ended);
                if (tries % 8 == 7) machine_.kill_one_if_any();
                continue;
            }
            if (is_merged()) return;
            age_leases(true);
            if (machine_.start({.stops_in_pauses = true}, worker(std::nullopt), ended) && ended.code != 0 &&
                !obey(ended))
                return say("a worker fails though nothing does: " + ended.said);
        }
        if (!is_merged()) say("the result does not come");
    }

    void judge() {
        Ended ended;
        machine_.start(
            {}, [&] { require_results(directory_.merged_file(), {reference_.hash}); }, ended);
        if (ended.code != 0) say("the result: " + ended.said);
    }

    Machine machine_;
    Draws& draws_;
    const Reference& reference_;
    cluster::StudyDirectory directory_;
    double late_after_s_ = 0.0;
    int operations_ = 0, rounds_ = 0;
};

}  // namespace

// In a process of its own, so that this one has no threads when it is forked.
Reference reference(const fs::path& folder) {
    Machine machine(0, folder);
    const fs::path config = machine.root / "small.toml", complete = folder / "complete.toml",
                   hash = folder / "hash";
    write_text(config, small_study);
    Ended ended;
    machine.start(
        {},
        [&] {
            const config::ReadConfig read = config::read_config(config);
            storage::Database database = storage::Database::open_or_create(machine.root / "reference.db");
            RunOptions options;
            options.jobs = 1;
            run_studies(database, config::runnable_studies(read), reports::program_version(), options);
            write_text(complete, config::config_text(read.plan, config::Comments::none));
            write_text(hash, storage::study_hash(database, 1));
        },
        ended);
    if (ended.code != 0) throw std::runtime_error("the reference: " + ended.said);
    Reference reference;
    std::ifstream(hash) >> reference.hash;
    std::ifstream text(complete);
    reference.config_toml.assign(std::istreambuf_iterator<char>(text), {});
    return reference;
}

SystemRun simulate_study(std::uint64_t seed, const Reference& reference, const fs::path& folder) {
    return StudyRun(seed, reference, folder).run();
}

}  // namespace capstan::faults
