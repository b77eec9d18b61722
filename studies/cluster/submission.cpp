#include "capstan/cluster/submission.h"

#include <fmt/format.h>

#include <stdexcept>

#include "capstan/cluster/shell_words.h"
#include "capstan/cluster/without_queue.h"
#include "capstan/platform/child_process.h"
#include "capstan/platform/files.h"

namespace capstan::cluster {

namespace fs = std::filesystem;

namespace {

// The script or workflow of a way without a queue; empty: it needs none.
std::string way_text(const Request& request) {
    const StudyDirectory& directory = request.directory;
    if (directory.scheduler == "parallel")
        return parallel_script(directory, request.hosts, request.arrays.throttle);
    return directory.scheduler == "snakemake" ? snakemake_workflow(directory) : "";
}

fs::path way_file(const StudyDirectory& directory) {
    return directory.path / (directory.scheduler == "snakemake" ? "Snakefile" : "parallel.sh");
}

std::string dry_run(const Request& request) {
    const StudyDirectory& directory = request.directory;
    std::string text = fmt::format("# {}\n{}\n# {}\n{}\n# Not submitted. Without --dry-run:\n",
                                   directory.shards_script().string(), read_file(directory.shards_script()),
                                   directory.merge_script().string(), read_file(directory.merge_script()));
    for (const auto& call :
         planned_calls(*request.scheduler, directory, shards_to_submit(directory, {}), request.arrays))
        text += as_typed(call) + "\n";
    return text;
}

std::string progress_hint(const StudyDirectory& directory) {
    return fmt::format("capstan study status {} shows the progress.\n", directory.path.string());
}

std::string submit_to_queue(const Request& request) {
    const StudyDirectory& directory = request.directory;
    const StudyQueue queue = read_queue(*request.scheduler, directory);
    const Submission done = submit(*request.scheduler, directory, queue, request.arrays);
    std::string text;
    if (!done.shards.empty()) {
        text +=
            fmt::format("Submitted shards {} of {} as {} {}{}.\n", as_array(done.shards), directory.shards,
                        done.array_jobs.size() == 1 ? "job" : "jobs", done.array_jobs.front(),
                        done.array_jobs.size() == 1 ? "" : " to " + done.array_jobs.back());
    }
    if (!queue.shards.empty()) text += fmt::format("In the queue already: {} shards.\n", queue.shards.size());
    if (!done.merge_job.empty()) {
        text +=
            fmt::format("Job {} merges them into {}.\n", done.merge_job, directory.merged_file().string());
    }
    if (text.empty()) text = "Everything is in the queue already.\n";
    return text + progress_hint(directory);
}

std::string start_without_queue(const Request& request, bool dry_run) {
    const StudyDirectory& directory = request.directory;
    const std::string folder = directory.path.string();
    if (directory.scheduler == "parallel")
        return fmt::format("Run it with: sh {}\n", way_file(directory).string()) + progress_hint(directory);
    if (directory.scheduler == "snakemake")
        return fmt::format("Run it with: snakemake --directory {0} --snakefile {0}/Snakefile --cores all\n",
                           folder) +
               progress_hint(directory);
    if (directory.scheduler == "none")
        return fmt::format(
                   "Run it with: capstan study work {} (on any number of machines that see the folder)\n",
                   folder) +
               progress_hint(directory);
    std::string text;
    for (const std::string& host : request.hosts) {
        const auto call = ssh_call(directory, host);
        text += (dry_run ? "" : "Started: ") + as_typed(call) + "\n";
        if (dry_run) continue;
        if (const CommandOutput done = run_command(call); done.exit_code != 0)
            throw std::runtime_error(fmt::format("no worker on {}: {}", host, done.messages));
    }
    return text + progress_hint(directory);
}

}  // namespace

void write_folder(const Request& request, const std::string& config_toml) {
    const StudyDirectory& directory = request.directory;
    fs::create_directories(directory.path / "logs");
    fs::create_directories(directory.leases_folder());
    if (!config_toml.empty()) write_file(directory.config_file(), config_toml);
    if (request.scheduler != nullptr) {
        write_file(directory.shards_script(), shards_script(*request.scheduler, directory));
        write_file(directory.merge_script(), merge_script(*request.scheduler, directory));
    } else if (const std::string text = way_text(request); !text.empty()) {
        write_file(way_file(directory), text);
    }
    write_file(directory.submission_file(), submission_text(directory));
}

std::string submit_request(const Request& request) {
    return request.scheduler == nullptr ? start_without_queue(request, false) : submit_to_queue(request);
}

std::string planned_request(const Request& request) {
    return request.scheduler == nullptr ? start_without_queue(request, true) : dry_run(request);
}

}  // namespace capstan::cluster
