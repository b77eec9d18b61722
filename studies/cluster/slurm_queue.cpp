#include "capstan/cluster/slurm_queue.h"

#include <sstream>
#include <stdexcept>

#include "capstan/platform/child_process.h"

namespace capstan::cluster {

namespace {

std::string without_line_end(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
    return text;
}

std::string run_or_throw(const std::vector<std::string>& words) {
    const CommandOutput done = run_command(words);
    if (done.exit_code != 0) {
        throw std::runtime_error(words[0] + " failed: " + without_line_end(done.messages));
    }
    return done.output;
}

// "1234", or "1234;cluster" of a federation.
std::string sbatch(std::vector<std::string> options, const std::filesystem::path& script) {
    options.insert(options.begin(), {"sbatch", "--parsable"});
    options.push_back(script.string());
    const std::string answer = without_line_end(run_or_throw(options));
    return answer.substr(0, answer.find(';'));
}

std::string after_all(const StudyQueue& queue, const std::string& array_job) {
    std::string dependency = "afterok";
    for (const auto& [number, task] : queue.shards) dependency += ":" + task.id;
    if (!array_job.empty()) dependency += ":" + array_job;
    return dependency;
}

}  // namespace

bool slurm_is_there() {
    return is_on_path("sbatch") && is_on_path("squeue");
}

StudyQueue read_queue(const StudyDirectory& directory) {
    StudyQueue queue;
    const std::string job = directory.job_name();
    std::istringstream lines(
        run_or_throw({"squeue", "--me", "--noheader", "--array", "--format=%F %K %T %j"}));
    std::string id, index, state, name;
    while (lines >> id >> index >> state && std::getline(lines >> std::ws, name)) {
        if (name == job + "-merge") queue.merge = QueuedTask{id, state};
        if (name != job) continue;
        queue.shards[std::stoi(index)] = {id + "_" + index, state};
    }
    return queue;
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

Submission submit(const StudyDirectory& directory, const StudyQueue& queue) {
    Submission submission;
    submission.shards = shards_to_submit(directory, queue);
    if (!submission.shards.empty()) {
        submission.array_job = sbatch({"--array=" + as_array(submission.shards)}, directory.shards_script());
    }
    if (queue.merge && submission.shards.empty()) return submission;
    if (queue.merge) run_or_throw({"scancel", queue.merge->id});
    std::vector<std::string> options;
    if (!queue.shards.empty() || !submission.array_job.empty()) {
        options = {"--dependency=" + after_all(queue, submission.array_job), "--kill-on-invalid-dep=yes"};
    }
    submission.merge_job = sbatch(options, directory.merge_script());
    return submission;
}

}  // namespace capstan::cluster
