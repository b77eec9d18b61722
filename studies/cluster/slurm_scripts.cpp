#include "capstan/cluster/slurm_queue.h"

namespace capstan::cluster {

namespace {

// For the shell that runs the script.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'')
            result += "'\\''";
        else
            result += c;
    }
    return result + "'";
}

// sbatch parses its lines itself and replaces %a and similar patterns; %% stands for one %.
std::string for_sbatch(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '%') result += '%';
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + "\"";
}

std::string head(const StudyDirectory& directory, const std::string& job, const std::string& log,
                 int processors) {
    return "#!/bin/sh\n"
           "#SBATCH --job-name=" +
           job +
           "\n"
           "#SBATCH --output=logs/" +
           log +
           "\n"
           "#SBATCH --open-mode=append\n"
           "#SBATCH --requeue\n"
           "#SBATCH --nodes=1\n"
           "#SBATCH --ntasks=1\n"
           "#SBATCH --cpus-per-task=" +
           std::to_string(processors) +
           "\n"
           "#SBATCH --chdir=" +
           for_sbatch(directory.path.string()) +
           "\n"
           "# Partition, time limit and the like: set SBATCH_PARTITION, SBATCH_TIMELIMIT, ... when you submit.\n"
           "set -eu\n";
}

}  // namespace

std::string shards_script(const StudyDirectory& directory) {
    const std::string count = std::to_string(directory.shards);
    return head(directory, directory.job_name(), "shard-%a.log", directory.processors_per_shard) +
           "shard=$SLURM_ARRAY_TASK_ID\n"
           "exec " +
           quoted(directory.program.string()) + " study run config.toml --shard \"$shard/" + count +
           "\" --db \"shard-$shard-of-" + count + ".db\" --jobs " +
           std::to_string(directory.processors_per_shard) + " --progress none\n";
}

std::string merge_script(const StudyDirectory& directory) {
    const std::string merged = directory.merged_file().filename().string();
    return head(directory, directory.job_name() + "-merge", "merge.log", 1) +
           "# A node that fails after the merge makes Slurm run this again.\n"
           "if [ -e " +
           merged +
           " ]; then exit 0; fi\n"
           "exec " +
           quoted(directory.program.string()) + " study merge --db " + merged +
           " --progress none shard-*-of-" + std::to_string(directory.shards) + ".db\n";
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

}  // namespace capstan::cluster
