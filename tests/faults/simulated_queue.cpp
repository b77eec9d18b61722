#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <set>
#include <stdexcept>
#include <thread>

#include "capstan/service/job_queue.h"
#include "simulated_machine.h"
#include "stored_results.h"

namespace capstan::faults {

namespace fs = std::filesystem;

namespace {

using service::Job;
using service::JobState;

class QueueRun {
  public:
    QueueRun(std::uint64_t seed, const Reference& reference, fs::path program, fs::path shim,
             const fs::path& folder)
        : machine_(seed, folder),
          draws_(machine_.draws),
          reference_(reference),
          program_(std::move(program)),
          shim_(std::move(shim)),
          wanted_(1 + draws_.below(3)),
          starts_(draws_.below(4)) {
        machine_.run.kind = std::to_string(wanted_) + " jobs, the service started " +
                            std::to_string(starts_) + " times with faults";
    }

    SystemRun run() {
        for (int start = 0; start < starts_ && machine_.run.problem.empty(); ++start) {
            serve(machine_.some_fault(draws_.one_in(2) ? 15 : 60),
                  draws_.one_in(3) ? 1 + draws_.below(300) : 0);
            // Of the jobs' programs, which write the database, it is not known what they synced.
            if (draws_.one_in(4))
                machine_.cut_power([](const std::string& name) { return !name.starts_with("served.db"); });
        }
        // Whoever asked for a job and got no answer asks again; what failed is resumed.
        for (int tries = 0; tries < 4 && machine_.run.problem.empty(); ++tries)
            if (serve({}, 0).code == 0) break;
        if (machine_.run.problem.empty()) judge();
        return machine_.run;
    }

  private:
    fs::path database() const { return machine_.root / "served.db"; }
    fs::path acknowledged() const { return machine_.root.parent_path() / "acknowledged"; }

    std::vector<int> numbers() const {
        std::vector<int> numbers;
        std::ifstream file(acknowledged());
        for (int number = 0; file >> number;) numbers.push_back(number);
        return numbers;
    }

    // A service until all jobs have ended. `child_fault`: the write of a job's program that fails; 0: none.
    Ended serve(Planned planned, int child_fault) {
        if (planned.fault == Fault::stop) planned.fault = Fault::kill;
        Ended ended;
        machine_.start(
            planned,
            [&] {
                if (child_fault > 0) {
                    ::setenv("LD_PRELOAD", shim_.c_str(), 1);
                    ::setenv("CAPSTAN_FAULT_AT", (std::to_string(child_fault) + " error").c_str(), 1);
                }
                storage::Database::open_or_create(database());
                service::JobQueue queue(database().string() + ".jobs",
                                        {program_.string(), database().string(), 1});
                for (const Job& job : queue.jobs())
                    if (job.state == JobState::failed) queue.resume(job.number);
                await(queue);
                while (static_cast<int>(numbers().size()) < wanted_) {
                    const std::vector<Job> added = queue.add_studies({{"small", reference_.config_toml}});
                    std::ofstream(acknowledged(), std::ios::app) << added.front().number << std::endl;
                    await(queue);
                }
                for (const Job& job : queue.jobs())
                    if (job.state != JobState::done) throw std::runtime_error("a job failed: " + job.message);
            },
            ended);
        return ended;
    }

    // One after the other, so that the operations on the disk come in one order.
    static void await(service::JobQueue& queue) {
        const auto is_open = [](const Job& job) {
            return job.state == JobState::queued || job.state == JobState::running;
        };
        for (;;) {
            bool any = false;
            for (const Job& job : queue.jobs()) any = any || is_open(job);
            if (!any) return;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }

    void judge() {
        Ended ended;
        machine_.start(
            {},
            [&] {
                const service::JobFolder folder(database().string() + ".jobs");
                const std::vector<Job> jobs = folder.read();
                std::set<int> kept;
                std::set<std::int64_t> results;
                for (const Job& job : jobs) {
                    if (!kept.insert(job.number).second) throw std::runtime_error("a number was given twice");
                    if (job.state != JobState::done)
                        throw std::runtime_error("a job is not done: " + job.message);
                    if (!job.result_id || !results.insert(*job.result_id).second)
                        throw std::runtime_error("two jobs have one result");
                }
                const std::vector<int> told = numbers();
                for (const int number : told)
                    if (kept.count(number) == 0)
                        throw std::runtime_error("job " + std::to_string(number) + " is lost");
                if (std::set<int>(told.begin(), told.end()).size() != told.size())
                    throw std::runtime_error("two clients were told one number");
                require_results(database(), std::vector<std::string>(jobs.size(), reference_.hash));
            },
            ended);
        if (ended.code != 0) machine_.run.problem = ended.said.empty() ? "the judge crashed" : ended.said;
    }

    Machine machine_;
    Draws& draws_;
    const Reference& reference_;
    const fs::path program_, shim_;
    const int wanted_, starts_;
};

}  // namespace

SystemRun simulate_queue(std::uint64_t seed, const Reference& reference, const fs::path& program,
                         const fs::path& shim, const fs::path& folder) {
    fs::remove(folder / "acknowledged");
    return QueueRun(seed, reference, program, shim, folder).run();
}

}  // namespace capstan::faults
