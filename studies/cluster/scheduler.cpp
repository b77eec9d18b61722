#include "capstan/cluster/scheduler.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "capstan/cluster/shell_words.h"
#include "capstan/platform/child_process.h"

namespace capstan::cluster {

namespace {

using Words = std::vector<std::string>;

// A single index stays "7", which every scheduler but PBS takes.
std::string range_of(const ShardArray& array) {
    return as_array(array.tasks);
}

// Each part of a study has a name of its own, because Slurm's jobs are found again by it.
std::string job_of(const StudyDirectory& directory, const ShardArray& array) {
    return directory.job_name() + (array.offset == 0 ? "" : "+" + std::to_string(array.offset));
}

std::string first_line(const std::string& text) {
    return text.substr(0, text.find_first_of("\r\n"));
}

std::string up_to(const std::string& text, std::string_view ends) {
    return text.substr(0, text.find_first_of(ends));
}

// What the pilot measured, in the scheduler's words; nothing where nothing was.
std::string requested(const char* words, int amount) {
    return amount > 0 ? fmt::format(fmt::runtime(words), amount) : "";
}

// ---- Slurm

std::string slurm_directives(const StudyDirectory& directory, const std::string& job, const std::string& log,
                             int processors) {
    return fmt::format(
        "#SBATCH --job-name={}\n#SBATCH --output=logs/{}\n#SBATCH --open-mode=append\n#SBATCH --requeue\n"
        "#SBATCH --nodes=1\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task={}\n#SBATCH --chdir={}\n"
        "{}{}"
        "# Partition, time limit and the like: set SBATCH_PARTITION, SBATCH_TIMELIMIT, ... when you submit.\n",
        job, log, processors, quoted_for_sbatch(directory.path.string()),
        requested("#SBATCH --time={}\n", directory.minutes_per_shard),
        requested("#SBATCH --mem={}M\n", directory.megabytes_per_shard));
}

Words slurm_submission(const StudyDirectory& directory, const ShardArray& array, int throttle) {
    Words words = {"sbatch", "--parsable",
                   "--array=" + range_of(array) + (throttle > 0 ? "%" + std::to_string(throttle) : "")};
    if (array.offset > 0) words.push_back("--job-name=" + job_of(directory, array));
    words.push_back(directory.shards_script().string());
    if (array.offset > 0) words.push_back(std::to_string(array.offset));
    return words;
}

Words slurm_merge(const StudyDirectory& directory, std::span<const std::string> jobs) {
    Words words = {"sbatch", "--parsable"};
    if (!jobs.empty()) {
        words.push_back(fmt::format("--dependency=afterok:{}", fmt::join(jobs, ":")));
        words.emplace_back("--kill-on-invalid-dep=yes");
    }
    words.push_back(directory.merge_script().string());
    return words;
}

// "1234", or "1234;cluster" of a federation.
std::string slurm_job(const std::string& answer) {
    return up_to(first_line(answer), ";");
}

Words slurm_question(const std::string& job) {
    return {"squeue", "--noheader", "--jobs=" + job};
}

// ---- Grid Engine

std::string gridengine_directives(const StudyDirectory& directory, const std::string& job,
                                  const std::string& log, int processors) {
    return fmt::format(
        "#$ -N {}\n#$ -S /bin/sh\n#$ -wd {}\n#$ -j y\n#$ -o logs/{}\n#$ -r y\n{}{}{}"
        "# Queue, time limit and the like: put them into ~/.sge_request.\n",
        job, directory.path.string(), log, processors > 1 ? fmt::format("#$ -pe smp {}\n", processors) : "",
        requested("#$ -l h_rt={}\n", 60 * directory.minutes_per_shard),
        requested("#$ -l mem_free={}M\n", directory.megabytes_per_shard));
}

Words gridengine_submission(const StudyDirectory& directory, const ShardArray& array, int throttle) {
    Words words = {"qsub", "-terse", "-t", range_of(array)};
    if (throttle > 0) words.insert(words.end(), {"-tc", std::to_string(throttle)});
    words.insert(words.end(), {"-N", job_of(directory, array), directory.shards_script().string(),
                               std::to_string(array.offset)});
    return words;
}

Words gridengine_merge(const StudyDirectory& directory, std::span<const std::string> jobs) {
    Words words = {"qsub", "-terse"};
    if (!jobs.empty()) words.insert(words.end(), {"-hold_jid", fmt::format("{}", fmt::join(jobs, ","))});
    words.push_back(directory.merge_script().string());
    return words;
}

// "12.1-1000:1" of an array.
std::string gridengine_job(const std::string& answer) {
    return up_to(first_line(answer), ".");
}

Words gridengine_question(const std::string& job) {
    return {"qstat", "-j", job};
}

// ---- PBS

std::string pbs_directives(const StudyDirectory& directory, const std::string& job, const std::string& log,
                           int processors) {
    return fmt::format(
        "#PBS -N {}\n#PBS -j oe\n#PBS -o {}/logs/{}\n#PBS -r y\n#PBS -l select=1:ncpus={}{}\n{}"
        "# Queue, time limit and the like: put them into PBS_DEFAULT or the queue's defaults.\n",
        job, directory.path.string(), log, processors, requested(":mem={}mb", directory.megabytes_per_shard),
        requested("#PBS -l walltime={}\n", 60 * directory.minutes_per_shard));
}

// A name has at most 15 characters there, and an array at least two tasks.
Words pbs_submission(const StudyDirectory& directory, const ShardArray& array, int throttle) {
    Words words = {"qsub"};
    std::string variables = "CAPSTAN_OFFSET=" + std::to_string(array.offset);
    if (array.tasks.size() == 1)
        variables += ",CAPSTAN_TASK=" + std::to_string(array.tasks.front());
    else
        words.insert(words.end(),
                     {"-J", range_of(array) + (throttle > 0 ? "%" + std::to_string(throttle) : "")});
    words.insert(words.end(), {"-v", variables, directory.shards_script().string()});
    return words;
}

Words pbs_merge(const StudyDirectory& directory, std::span<const std::string> jobs) {
    Words words = {"qsub"};
    if (!jobs.empty())
        words.insert(words.end(), {"-W", fmt::format("depend=afterok:{}", fmt::join(jobs, ":"))});
    words.push_back(directory.merge_script().string());
    return words;
}

// "12[].server"
std::string pbs_job(const std::string& answer) {
    return first_line(answer);
}

Words pbs_question(const std::string& job) {
    return {"qstat", job};
}

// ---- LSF

std::string lsf_directives(const StudyDirectory&, const std::string&, const std::string&, int) {
    return "# Queue, time limit and the like: set LSB_DEFAULTQUEUE, ... when you submit.\n";
}

Words lsf_head(const StudyDirectory& directory, const std::string& job, int processors) {
    return {"bsub",
            "-J",
            job,
            "-cwd",
            directory.path.string(),
            "-o",
            "logs/scheduler.log",
            "-n",
            std::to_string(processors),
            "-R",
            "span[hosts=1]",
            "-r"};
}

Words lsf_submission(const StudyDirectory& directory, const ShardArray& array, int throttle) {
    Words words = lsf_head(directory,
                           fmt::format("{}[{}]{}", job_of(directory, array), range_of(array),
                                       throttle > 0 ? "%" + std::to_string(throttle) : ""),
                           directory.processors_per_shard);
    if (directory.minutes_per_shard > 0)
        words.insert(words.end(), {"-W", std::to_string(directory.minutes_per_shard)});
    if (directory.megabytes_per_shard > 0)
        words.insert(words.end(), {"-M", std::to_string(directory.megabytes_per_shard) + "MB"});
    words.insert(words.end(), {"sh", directory.shards_script().string(), std::to_string(array.offset)});
    return words;
}

Words lsf_merge(const StudyDirectory& directory, std::span<const std::string> jobs) {
    Words words = lsf_head(directory, directory.job_name() + "-merge", 1);
    std::string condition;
    for (const std::string& job : jobs) condition += (condition.empty() ? "done(" : " && done(") + job + ")";
    if (!condition.empty()) words.insert(words.end(), {"-w", condition});
    words.insert(words.end(), {"sh", directory.merge_script().string()});
    return words;
}

// "Job <12> is submitted to queue <normal>."
std::string lsf_job(const std::string& answer) {
    const std::size_t begin = answer.find('<');
    return begin == std::string::npos ? "" : up_to(answer.substr(begin + 1), ">");
}

// bjobs forgets a job some time after it has ended, and until then calls it done.
Words lsf_question(const std::string& job) {
    return {"sh", "-c", "bjobs -noheader -o stat " + job + " | grep -qE 'PEND|RUN|SUSP|WAIT'"};
}

constexpr Scheduler all_schedulers[] = {
    {"slurm", "Slurm", "sbatch", "squeue", "scancel", "SLURM_ARRAY_TASK_ID", 1000, true, slurm_directives,
     slurm_submission, slurm_merge, slurm_job, slurm_question},
    {"gridengine", "Grid Engine", "qsub", "qstat", "qdel", "SGE_TASK_ID", 75000, false, gridengine_directives,
     gridengine_submission, gridengine_merge, gridengine_job, gridengine_question},
    {"pbs", "PBS", "qsub", "qstat", "qdel", "PBS_ARRAY_INDEX", 10000, false, pbs_directives, pbs_submission,
     pbs_merge, pbs_job, pbs_question},
    {"lsf", "LSF", "bsub", "bjobs", "bkill", "LSB_JOBINDEX", 1000, true, lsf_directives, lsf_submission,
     lsf_merge, lsf_job, lsf_question},
};

std::string script_head(const Scheduler& scheduler, const StudyDirectory& directory, const std::string& job,
                        const std::string& log, int processors) {
    return "#!/bin/sh\n" + scheduler.directives(directory, job, log, processors) + "set -eu\ncd " +
           quoted(directory.path.string()) + "\n";
}

}  // namespace

const Scheduler* find_scheduler(std::string_view name) {
    const auto found = std::find_if(std::begin(all_schedulers), std::end(all_schedulers),
                                    [&](const Scheduler& scheduler) { return scheduler.name == name; });
    return found == std::end(all_schedulers) ? nullptr : found;
}

bool is_there(const Scheduler& scheduler) {
    return is_on_path(std::string(scheduler.submit_program)) &&
           is_on_path(std::string(scheduler.status_program));
}

int array_limit_of(const Scheduler& scheduler, int stated) {
    if (stated > 0) return stated;
    if (scheduler.name != "slurm" || !is_on_path("scontrol")) return scheduler.array_limit;
    const std::string config = run_command({"scontrol", "show", "config"}).output;
    const std::size_t at = config.find("MaxArraySize");
    const std::size_t digits = at == std::string::npos ? at : config.find_first_of("0123456789", at);
    int size = 0;
    if (digits == std::string::npos) return scheduler.array_limit;
    std::from_chars(config.data() + digits, config.data() + config.size(), size);
    return std::max(size - 1, 1);
}

std::vector<ShardArray> arrays_of(const std::vector<int>& shards, int limit, bool takes_lists) {
    std::vector<ShardArray> arrays;
    for (const int shard : shards) {
        const int offset = (shard - 1) / limit * limit;
        const int task = shard - offset;
        const bool continues = !arrays.empty() && arrays.back().offset == offset &&
                               (takes_lists || arrays.back().tasks.back() + 1 == task);
        if (!continues) arrays.push_back({offset, {}});
        arrays.back().tasks.push_back(task);
    }
    return arrays;
}

std::string as_array(const std::vector<int>& numbers) {
    std::string text;
    for (std::size_t k = 0; k < numbers.size();) {
        std::size_t end = k;
        while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
        text += (text.empty() ? "" : ",") + std::to_string(numbers[k]);
        if (end > k) text += "-" + std::to_string(numbers[end]);
        k = end + 1;
    }
    return text;
}

std::string shards_script(const Scheduler& scheduler, const StudyDirectory& directory) {
    const std::string variable(scheduler.task_variable);
    return script_head(scheduler, directory, directory.job_name(), "scheduler.log",
                       directory.processors_per_shard) +
           "# The first argument, or CAPSTAN_OFFSET, is added to the index: an array has a largest one.\n"
           "shard=$((${CAPSTAN_TASK:-$" +
           variable + "} + ${1:-${CAPSTAN_OFFSET:-0}}))\nexec >> \"logs/shard-$shard.log\" 2>&1\nexec " +
           quoted(directory.program.string()) + " study work . --shard \"$shard\" --progress none\n";
}

std::string merge_script(const Scheduler& scheduler, const StudyDirectory& directory) {
    StudyDirectory merge = directory;  // what was measured is of a shard
    merge.minutes_per_shard = merge.megabytes_per_shard = 0;
    return script_head(scheduler, merge, directory.job_name() + "-merge", "merge.log", 1) +
           "# Does nothing where the last worker has merged, or after a node that fails later.\nexec " +
           quoted(directory.program.string()) + " study work . --merge --progress none\n";
}

}  // namespace capstan::cluster
