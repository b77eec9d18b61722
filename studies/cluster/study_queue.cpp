#include "capstan/cluster/study_queue.h"

#include <charconv>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "capstan/cluster/shell_words.h"
#include "capstan/platform/child_process.h"

namespace capstan::cluster {

namespace {

std::string run_or_throw(const std::vector<std::string>& words) {
    const CommandOutput done = run_command(words);
    if (done.exit_code != 0) {
        throw std::runtime_error(words[0] + " failed: " + without_line_end(done.messages));
    }
    return done.output;
}

// The offset that a job's name ends in, as "capstan-1234abcd+1000"; nothing: it is another job.
std::optional<int> offset_in(const std::string& name, const std::string& job) {
    if (name == job) return 0;
    if (!name.starts_with(job + "+")) return std::nullopt;
    int offset = 0;
    const char* const end = name.data() + name.size();
    if (std::from_chars(name.data() + job.size() + 1, end, offset).ptr != end) return std::nullopt;
    return offset;
}

StudyQueue read_slurm_queue(const StudyDirectory& directory) {
    StudyQueue queue;
    const std::string job = directory.job_name();
    std::istringstream lines(
        run_or_throw({"squeue", "--me", "--noheader", "--array", "--format=%F %K %T %j"}));
    std::string id, index, state, name;
    while (lines >> id >> index >> state && std::getline(lines >> std::ws, name)) {
        if (name == job + "-merge") queue.merge = QueuedTask{id, state};
        if (const auto offset = offset_in(name, job))
            queue.shards[std::stoi(index) + *offset] = {id + "_" + index, state};
    }
    return queue;
}

// A line of the record: a job and the first and last shard of each run of shards that it has; "merge" for a
// merge.
void record_job(const StudyDirectory& directory, const std::string& job, const std::vector<int>& shards) {
    std::ofstream record(directory.jobs_file(), std::ios::app);
    record << job << ' ' << (shards.empty() ? "merge" : as_array(shards)) << '\n';
    if (!record.flush()) throw std::runtime_error("cannot write " + directory.jobs_file().string());
}

std::vector<int> listed(const std::string& ranges) {
    std::vector<int> numbers;
    std::istringstream parts(ranges);
    std::string part;
    while (std::getline(parts, part, ',')) {
        const std::size_t dash = part.find('-');
        const int first = std::stoi(part);
        const int last = dash == std::string::npos ? first : std::stoi(part.substr(dash + 1));
        for (int number = first; number <= last; ++number) numbers.push_back(number);
    }
    return numbers;
}

StudyQueue read_recorded_queue(const Scheduler& scheduler, const StudyDirectory& directory) {
    StudyQueue queue;
    std::ifstream record(directory.jobs_file());
    std::string job, shards;
    while (record >> job >> shards) {
        if (run_command(scheduler.question(job)).exit_code != 0) continue;
        if (shards == "merge") {
            queue.merge = QueuedTask{job, "QUEUED"};
            continue;
        }
        for (const int number : listed(shards))
            if (!progress_of(directory, number).is_done()) queue.shards[number] = {job, "QUEUED"};
    }
    return queue;
}

// A scheduler may end a merge at once if one of its jobs has failed tasks already, so that the tasks
// themselves are named, unless they are very many.
std::vector<std::string> jobs_before_merge(const StudyQueue& queue, const std::vector<std::string>& arrays) {
    constexpr std::size_t few = 200;
    std::set<std::string> jobs;
    for (const auto& [number, task] : queue.shards)
        jobs.insert(queue.shards.size() <= few ? task.id : task.id.substr(0, task.id.find('_')));
    std::vector<std::string> all(jobs.begin(), jobs.end());
    all.insert(all.end(), arrays.begin(), arrays.end());
    return all;
}

std::vector<int> shards_of(const ShardArray& array) {
    std::vector<int> shards = array.tasks;
    for (int& shard : shards) shard += array.offset;
    return shards;
}

}  // namespace

StudyQueue read_queue(const Scheduler& scheduler, const StudyDirectory& directory) {
    return scheduler.name == "slurm" ? read_slurm_queue(directory)
                                     : read_recorded_queue(scheduler, directory);
}

std::vector<int> shards_to_submit(const StudyDirectory& directory, const StudyQueue& queue) {
    std::vector<int> numbers;
    for (int number = 1; number <= directory.shards; ++number) {
        if (queue.shards.count(number) == 0 && !progress_of(directory, number).is_done()) {
            numbers.push_back(number);
        }
    }
    return numbers;
}

std::vector<std::vector<std::string>> planned_calls(const Scheduler& scheduler,
                                                    const StudyDirectory& directory,
                                                    const std::vector<int>& shards,
                                                    const ArrayOptions& options) {
    std::vector<std::vector<std::string>> calls;
    std::vector<std::string> jobs;
    for (const ShardArray& array :
         arrays_of(shards, array_limit_of(scheduler, options.limit), scheduler.takes_lists)) {
        calls.push_back(scheduler.submission(directory, array, options.throttle));
        jobs.emplace_back("JOB");
    }
    calls.push_back(scheduler.merge_submission(directory, jobs));
    return calls;
}

Submission submit(const Scheduler& scheduler, const StudyDirectory& directory, const StudyQueue& queue,
                  const ArrayOptions& options) {
    Submission submission;
    submission.shards = shards_to_submit(directory, queue);
    const bool is_recorded = scheduler.name != "slurm";
    const auto submit_call = [&](const std::vector<std::string>& words, const std::vector<int>& shards) {
        const std::string job = scheduler.job_id(run_or_throw(words));
        if (job.empty()) throw std::runtime_error(words[0] + " did not say the number of the job");
        if (is_recorded) record_job(directory, job, shards);
        return job;
    };
    const int limit = array_limit_of(scheduler, options.limit);
    for (const ShardArray& array : arrays_of(submission.shards, limit, scheduler.takes_lists))
        submission.array_jobs.push_back(
            submit_call(scheduler.submission(directory, array, options.throttle), shards_of(array)));
    if (queue.merge && submission.shards.empty()) return submission;
    if (queue.merge) run_or_throw({std::string(scheduler.cancel_program), queue.merge->id});
    submission.merge_job = submit_call(
        scheduler.merge_submission(directory, jobs_before_merge(queue, submission.array_jobs)), {});
    return submission;
}

}  // namespace capstan::cluster
