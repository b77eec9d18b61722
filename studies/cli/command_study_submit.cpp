#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/cluster/shell_words.h"
#include "capstan/cluster/study_queue.h"
#include "capstan/cluster/without_queue.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"
#include "capstan/platform/child_process.h"
#include "capstan/platform/files.h"
#include "capstan/worlds/world_shard.h"

namespace capstan::cli {

namespace {

namespace fs = std::filesystem;
using cluster::StudyDirectory;

// As it will stand in the scripts: a line break would end an #SBATCH line.
fs::path absolute_directory(const std::string& named) {
    fs::path path = fs::weakly_canonical(fs::absolute(named));
    if (!path.has_filename()) path = path.parent_path();
    if (path.string().find('\n') != std::string::npos) {
        throw UsageError(
            "--directory has a line break in its name, which Slurm does not accept; name another");
    }
    return path;
}

// The same study may be submitted again into its folder; any other folder must be new or empty.
void require_own_folder(const StudyDirectory& directory, const std::string& config_toml) {
    if (!fs::exists(directory.path) || fs::is_empty(directory.path)) return;
    const std::string name = directory.path.string();
    if (!fs::exists(directory.submission_file())) {
        throw UsageError(name + " holds other files; name a new folder for the study");
    }
    const StudyDirectory before = cluster::read_directory(directory.path);
    if (before.shards != directory.shards) {
        throw UsageError(
            fmt::format("{0} holds the study in {1} shards, not {2}; submit with --shards {1}, or "
                        "name a new folder",
                        name, before.shards, directory.shards));
    }
    if (read_file(directory.config_file()) != config_toml) {
        throw UsageError(
            name +
            " holds a study with another configuration; name a new folder (in it, config.toml is "
            "the one that runs there)");
    }
}

struct Request {
    StudyDirectory directory;
    const cluster::Scheduler* scheduler = nullptr;  // null: one of the ways without a queue
    cluster::ArrayOptions arrays;
    std::vector<std::string> hosts;
};

std::string stated_scheduler(const Invocation& invocation) {
    if (invocation.has("scheduler")) return invocation.text("scheduler");
    if (invocation.has("slurm")) return "slurm";
    throw UsageError(
        "capstan study submit: give --slurm, or --scheduler with the name of another one. Without any, run "
        "`capstan study run CONFIG --shard I/N` for each shard, then `capstan study merge`.");
}

// The script or workflow of a way without a queue; empty: it needs none.
std::string way_text(const Request& request) {
    const StudyDirectory& directory = request.directory;
    if (directory.scheduler == "parallel")
        return cluster::parallel_script(directory, request.hosts, request.arrays.throttle);
    return directory.scheduler == "snakemake" ? cluster::snakemake_workflow(directory) : "";
}

fs::path way_file(const StudyDirectory& directory) {
    return directory.path / (directory.scheduler == "snakemake" ? "Snakefile" : "parallel.sh");
}

// submission.json last: it marks a complete folder.
void write_folder(const Request& request, const std::string& config_toml) {
    const StudyDirectory& directory = request.directory;
    fs::create_directories(directory.path / "logs");
    fs::create_directories(directory.leases_folder());
    write_file(directory.config_file(), config_toml);
    if (request.scheduler != nullptr) {
        write_file(directory.shards_script(), cluster::shards_script(*request.scheduler, directory));
        write_file(directory.merge_script(), cluster::merge_script(*request.scheduler, directory));
    } else if (const std::string text = way_text(request); !text.empty()) {
        write_file(way_file(directory), text);
    }
    write_file(directory.submission_file(), cluster::submission_text(directory));
}

void say_dry_run(const Request& request) {
    const StudyDirectory& directory = request.directory;
    std::string text = fmt::format("# {}\n{}\n# {}\n{}\n# Not submitted. Without --dry-run:\n",
                                   directory.shards_script().string(), read_file(directory.shards_script()),
                                   directory.merge_script().string(), read_file(directory.merge_script()));
    for (const auto& call : cluster::planned_calls(*request.scheduler, directory,
                                                   cluster::shards_to_submit(directory, {}), request.arrays))
        text += cluster::as_typed(call) + "\n";
    write_standard_output(text);
}

std::string progress_hint(const StudyDirectory& directory) {
    return fmt::format("capstan study status {} shows the progress.\n", directory.path.string());
}

void submit(const Request& request) {
    const StudyDirectory& directory = request.directory;
    const cluster::StudyQueue queue = cluster::read_queue(*request.scheduler, directory);
    const cluster::Submission done = cluster::submit(*request.scheduler, directory, queue, request.arrays);
    std::string text;
    if (!done.shards.empty()) {
        text += fmt::format("Submitted shards {} of {} as {} {}{}.\n", cluster::as_array(done.shards),
                            directory.shards, done.array_jobs.size() == 1 ? "job" : "jobs",
                            done.array_jobs.front(),
                            done.array_jobs.size() == 1 ? "" : " to " + done.array_jobs.back());
    }
    if (!queue.shards.empty()) text += fmt::format("In the queue already: {} shards.\n", queue.shards.size());
    if (!done.merge_job.empty()) {
        text +=
            fmt::format("Job {} merges them into {}.\n", done.merge_job, directory.merged_file().string());
    }
    if (text.empty()) text = "Everything is in the queue already.\n";
    write_standard_output(text + progress_hint(directory));
}

void start_without_queue(const Request& request, bool dry_run) {
    const StudyDirectory& directory = request.directory;
    const std::string folder = directory.path.string();
    if (directory.scheduler == "parallel")
        return write_standard_output(fmt::format("Run it with: sh {}\n", way_file(directory).string()) +
                                     progress_hint(directory));
    if (directory.scheduler == "snakemake")
        return write_standard_output(
            fmt::format("Run it with: snakemake --directory {0} --snakefile {0}/Snakefile --cores all\n",
                        folder) +
            progress_hint(directory));
    std::string text;
    for (const std::string& host : request.hosts) {
        const auto call = cluster::ssh_call(directory, host);
        text += (dry_run ? "" : "Started: ") + cluster::as_typed(call) + "\n";
        if (dry_run) continue;
        if (const CommandOutput done = run_command(call); done.exit_code != 0)
            throw std::runtime_error(fmt::format("no worker on {}: {}", host, done.messages));
    }
    write_standard_output(text + progress_hint(directory));
}

Request request_of(const Invocation& invocation, const std::string& study_name) {
    Request request;
    StudyDirectory& directory = request.directory;
    directory.scheduler = stated_scheduler(invocation);
    request.scheduler = cluster::find_scheduler(directory.scheduler);
    directory.path = absolute_directory(invocation.text("directory"));
    directory.name = study_name;
    directory.shards = static_cast<int>(invocation.integer("shards"));
    directory.processors_per_shard = static_cast<int>(invocation.integer("processors"));
    directory.program = fs::read_symlink("/proc/self/exe");
    if (invocation.has("simd")) directory.simd = invocation.text("simd");
    if (invocation.has("array-limit"))
        request.arrays.limit = static_cast<int>(invocation.integer("array-limit"));
    if (invocation.has("throttle"))
        request.arrays.throttle = static_cast<int>(invocation.integer("throttle"));
    if (invocation.has("hosts")) request.hosts = split_at_commas(invocation.text("hosts"));
    if (directory.scheduler == "ssh" && request.hosts.empty())
        throw UsageError("capstan study submit: --scheduler ssh needs --hosts, such as --hosts node1,node2");
    return request;
}

void require_scheduler(const cluster::Scheduler& scheduler) {
    if (cluster::is_there(scheduler)) return;
    throw UsageError(
        fmt::format("capstan study submit: {} and {} are not on PATH, so there is no {} here. Run "
                    "this on a machine of the cluster, or use --dry-run to see what would be submitted.",
                    scheduler.submit_program, scheduler.status_program, scheduler.title));
}

ExitCode run_study_submit(const Invocation& invocation) {
    const config::ReadConfig config = read_config_of(invocation);
    const Request request = request_of(invocation, config.plan.name);
    const StudyDirectory& directory = request.directory;
    const std::vector<StudyPlan> plans = config::runnable_studies(config);
    if (config.plan.uncertainty.is_stated) {
        require_one_of_worlds(plans);
        require_worlds_for(plans.front(), directory.shards);
    } else {
        require_useful(plans, {1, directory.shards});
    }
    const bool dry_run = invocation.has("dry-run");
    if (!dry_run && request.scheduler != nullptr) require_scheduler(*request.scheduler);
    require_own_folder(directory, config::config_text(config.plan, config::Comments::none));
    if (fs::exists(directory.merged_file())) {
        write_standard_output(fmt::format(
            "{} is complete; nothing to submit. `capstan recommend --db {}` shows the recommendation.\n",
            directory.name, directory.merged_file().string()));
        return ExitCode::success;
    }
    write_folder(request, config::config_text(config.plan, config::Comments::none));
    if (request.scheduler == nullptr)
        start_without_queue(request, dry_run);
    else if (dry_run)
        say_dry_run(request);
    else
        submit(request);
    return ExitCode::success;
}

}  // namespace

Command study_submit_command() {
    return {
        .name = "study submit",
        .summary = "Run a study on a cluster, in shards.",
        .description =
            "Writes a folder with what a scheduler needs to run CONFIG in shards, and submits it: arrays with "
            "one task per shard, within the largest array that the cluster allows, and a job that merges the "
            "shards. The scheduler starts the tasks again when a node fails; such a task continues where it "
            "stopped. Each task works under a lease on the shared disk, and computes a shard of a slow node once "
            "more when its own is done, so that one node does not delay the result. Running the command again "
            "submits only the shards that are neither done nor in the queue. Without a queue, ssh starts a worker "
            "on each host, and for GNU parallel and Snakemake the folder gets a script or a workflow. All machines "
            "must see the folder and this program under the same path. Partition, account and time limit are "
            "options of the scheduler: for Slurm set SBATCH_PARTITION, SBATCH_ACCOUNT, SBATCH_TIMELIMIT.",
        .arguments = {config_argument},
        .options = {{.name = "slurm", .kind = OptionKind::flag, .meaning = "The same as --scheduler slurm."},
                    {.name = "scheduler",
                     .value = "NAME",
                     .meaning =
                         "slurm, gridengine (Grid Engine), pbs, lsf, ssh, parallel (GNU) or snakemake.",
                     .choices = {"slurm", "gridengine", "pbs", "lsf", "ssh", "parallel", "snakemake"}},
                    {.name = "shards",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "Number of shards; `capstan study plan` suggests one.",
                     .default_value = "8",
                     .low = 1,
                     .high = 1e6},
                    {.name = "directory",
                     .value = "DIR",
                     .meaning = "The study's folder: scripts, shards, logs, and the result study.db.",
                     .default_value = "capstan-study"},
                    {.name = "processors",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "Processors per task.",
                     .default_value = "1",
                     .low = 1,
                     .high = 1024},
                    {.name = "array-limit",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning =
                         "Largest index of an array, by default what the cluster says (Slurm: MaxArraySize "
                         "less one) or the scheduler's usual limit; more shards go into several arrays.",
                     .low = 1,
                     .high = 1e6},
                    {.name = "throttle",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "Largest number of tasks of an array at a time; by default no limit.",
                     .low = 1,
                     .high = 1e6},
                    {.name = "hosts",
                     .value = "A,B",
                     .meaning = "Hosts for ssh, and for GNU parallel, which otherwise runs on this machine."},
                    {.name = "dry-run",
                     .kind = OptionKind::flag,
                     .meaning = "Write the folder and print the scripts, but submit nothing."},
                    seed_option,
                    repetitions_option,
                    simd_option,
                    help_option},
        .examples = {"capstan study submit --slurm configs/atlas.toml --shards 100 --directory atlas",
                     "SBATCH_PARTITION=long capstan study submit --slurm my.toml",
                     "capstan study submit --scheduler pbs my.toml --shards 2500 --throttle 200",
                     "capstan study submit --scheduler ssh --hosts node1,node2 my.toml"},
        .run = run_study_submit};
}

}  // namespace capstan::cli
