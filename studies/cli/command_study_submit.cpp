#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/cluster/batch_inputs.h"
#include "capstan/cluster/batch_work.h"
#include "capstan/cluster/submission.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"
#include "capstan/placement/study_cost.h"
#include "capstan/platform/files.h"
#include "capstan/platform/peak_memory.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/worlds/world_shard.h"

namespace capstan::cli {

namespace {

namespace fs = std::filesystem;
using cluster::Request;
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
    if (before.shards != directory.shards && !directory.batch) {
        throw UsageError(
            fmt::format("{0} holds the study in {1} shards, not {2}; submit with --shards {1}, or "
                        "name a new folder",
                        name, before.shards, directory.shards));
    }
    if (before.batch != directory.batch)
        throw UsageError(name + " holds another batch, or a study; name a new folder");
    if (!directory.batch && read_file(directory.config_file()) != config_toml) {
        throw UsageError(
            name +
            " holds a study with another configuration; name a new folder (in it, config.toml is "
            "the one that runs there)");
    }
}

std::string stated_scheduler(const Invocation& invocation) {
    if (invocation.has("scheduler")) return invocation.text("scheduler");
    if (invocation.has("slurm")) return "slurm";
    if (invocation.command().name == "batch") return "none";
    throw UsageError(
        "capstan study submit: give --slurm, or --scheduler with the name of another one. Without any, run "
        "`capstan study run CONFIG --shard I/N` for each shard, then `capstan study merge`.");
}

Request request_of(const Invocation& invocation, const std::string& study_name) {
    Request request;
    StudyDirectory& directory = request.directory;
    directory.scheduler = stated_scheduler(invocation);
    request.scheduler = cluster::find_scheduler(directory.scheduler);
    directory.path = absolute_directory(invocation.text("directory"));
    directory.name = study_name;
    directory.processors_per_shard = invocation.count("processors");
    directory.program = fs::read_symlink("/proc/self/exe");
    invocation.take("simd", directory.simd);
    invocation.take("array-limit", request.arrays.limit);
    invocation.take("throttle", request.arrays.throttle);
    if (invocation.has("hosts")) request.hosts = split_at_commas(invocation.text("hosts"));
    if (directory.scheduler == "ssh" && request.hosts.empty())
        throw UsageError("--scheduler ssh needs --hosts, such as --hosts node1,node2");
    return request;
}

void require_scheduler(const cluster::Scheduler& scheduler) {
    if (cluster::is_there(scheduler)) return;
    throw UsageError(
        fmt::format("{} and {} are not on PATH, so there is no {} here. Run "
                    "this on a machine of the cluster, or use --dry-run to see what would be submitted.",
                    scheduler.submit_program, scheduler.status_program, scheduler.title));
}

// Several times what a pilot on this machine measured: other nodes are slower, and a shard that ends at its
// limit has to be submitted again.
void request_as_measured(const Invocation& invocation, const std::vector<StudyPlan>& plans,
                         StudyDirectory& directory) {
    constexpr double times = 4.0;
    constexpr int min_minutes = 10;
    constexpr int min_megabytes = 500;
    const double pilot_s = invocation.number("pilot");
    if (pilot_s == 0.0) return;
    ShownWork work(invocation, "pilot of " + directory.name);
    const StudyCost cost = predict_cost(plans, {pilot_s});
    work.end();
    const int owned = (cost.parts + directory.shards - 1) / directory.shards;  // by the largest shard
    const double mean_shard_s = cost.processor_s_with(plans, directory.shards) / directory.shards;
    const double shard_s =
        mean_shard_s * owned * directory.shards / cost.parts / directory.processors_per_shard;
    directory.minutes_per_shard = std::max(min_minutes, static_cast<int>(std::ceil(times * shard_s / 60.0)));
    directory.megabytes_per_shard =
        std::max(min_megabytes, static_cast<int>(times * static_cast<double>(peak_memory_bytes()) / 1e6));
    say(fmt::format(
        "The pilot predicts {} for the largest shard; asked of {}: {} min and {} MB for each.",
        shard_s < 90.0 ? fmt::format("{:.2g} s", shard_s) : fmt::format("{:.0f} min", shard_s / 60.0),
        directory.scheduler, directory.minutes_per_shard, directory.megabytes_per_shard));
}

ExitCode run_study_submit(const Invocation& invocation) {
    const config::ReadConfig config = read_config_of(invocation);
    Request request = request_of(invocation, config.plan.name);
    StudyDirectory& directory = request.directory;
    directory.shards = invocation.count("shards");
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
    if (request.scheduler != nullptr && !config.plan.uncertainty.is_stated)
        request_as_measured(invocation, plans, directory);
    cluster::write_folder(request, config::config_text(config.plan, config::Comments::none));
    write_standard_output(dry_run ? cluster::planned_request(request) : cluster::submit_request(request));
    return ExitCode::success;
}

// The options of whatever runs as shards.
std::vector<Option> and_where_it_runs(std::vector<Option> options) {
    const std::vector<Option> where = {
        {.name = "scheduler",
         .value = "NAME",
         .meaning = "slurm, gridengine (Grid Engine), pbs, lsf, ssh, parallel (GNU) or snakemake.",
         .choices = {"slurm", "gridengine", "pbs", "lsf", "ssh", "parallel", "snakemake"}},
        {.name = "processors",
         .kind = OptionKind::integer,
         .value = "N",
         .meaning = "Processors per task.",
         .default_value = "1",
         .limits = {1, 1024}},
        {.name = "array-limit",
         .kind = OptionKind::integer,
         .value = "N",
         .meaning = "Largest index of an array, by default what the cluster says (Slurm: MaxArraySize "
                    "less one) or the scheduler's usual limit; more shards go into several arrays.",
         .limits = {1, 1e6}},
        {.name = "throttle",
         .kind = OptionKind::integer,
         .value = "N",
         .meaning = "Largest number of tasks of an array at a time; by default no limit.",
         .limits = {1, 1e6}},
        {.name = "hosts",
         .value = "A,B",
         .meaning = "Hosts for ssh, and for GNU parallel, which otherwise runs on this machine."},
        {.name = "dry-run", .meaning = "Write the folder and print the scripts, but submit nothing."},
        simd_option,
        help_option};
    options.insert(options.end(), where.begin(), where.end());
    return options;
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
            "must see the folder and this program under the same path. A short pilot gives the time "
            "and memory that are asked for each shard. Partition and account are options of the scheduler: for Slurm set "
            "SBATCH_PARTITION, SBATCH_ACCOUNT; SBATCH_TIMELIMIT replaces the measured time.",
        .arguments = {config_argument},
        .options = and_where_it_runs({
            {.name = "slurm", .meaning = "The same as --scheduler slurm."},
            {.name = "shards",
             .kind = OptionKind::integer,
             .value = "N",
             .meaning = "Number of shards; `capstan study plan` suggests one.",
             .default_value = "8",
             .limits = {1, 1e6}},
            {.name = "directory",
             .value = "DIR",
             .meaning = "The study's folder: scripts, shards, logs, and the result study.db.",
             .default_value = "capstan-study"},
            {.name = "pilot",
             .kind = OptionKind::number,
             .value = "SECONDS",
             .meaning =
                 "Processor time of the pilot whose measurement becomes the time and memory that are asked of the "
                 "scheduler, four times each; 0 asks for none. A study over worlds asks for none.",
             .default_value = "1",
             .limits = {0, 1e5}},
            seed_option,
            repetitions_option,
            progress_option,
        }),
        .examples = {"capstan study submit --slurm configs/atlas.toml --shards 100 --directory atlas",
                     "SBATCH_PARTITION=long capstan study submit --slurm my.toml",
                     "capstan study submit --scheduler pbs my.toml --shards 2500 --throttle 200",
                     "capstan study submit --scheduler ssh --hosts node1,node2 my.toml"},
        .run = run_study_submit,
        .time =
            "The pilot takes a second, or longer where `study plan` does; the rest less than 2 s for some hundred shards, 20 s "
            "for 100,000. Shows progress of the pilot and the time left."};
}

namespace {

cluster::Batch batch_of(const Invocation& invocation) {
    cluster::Batch batch;
    batch.command = invocation.argument("COMMAND");
    if (std::find(std::begin(cluster::batch_commands), std::end(cluster::batch_commands), batch.command) ==
        std::end(cluster::batch_commands))
        throw UsageError(
            fmt::format("'{}' cannot run as a batch; there are diagnose, gap-trial, place and sensitivity",
                        batch.command));
    if (invocation.has("with")) batch.options = split_at_blanks(invocation.text("with"));
    batch.inputs = cluster::batch_inputs(batch.command, invocation.repeated_argument());
    // A wrong option is found now, and not by every task.
    for (const std::string& word : batch.options)
        for (const char* writes :
             {"-o", "--output", "--html", "--corrected", "--prediction", "--save", "--format"})
            if (word == writes || word.starts_with(std::string(writes) + "="))
                throw UsageError(
                    fmt::format("--with \"{}\": the batch keeps the answers itself, as JSON", word));
    std::vector<std::string> words = batch.words(1, 1);
    words.erase(words.begin());
    parse_command_line(*find_command(batch.command), words);
    return batch;
}

ExitCode run_batch(const Invocation& invocation) {
    Request request = request_of(invocation, "");
    StudyDirectory& directory = request.directory;
    directory.batch = batch_of(invocation);
    directory.shards = cluster::shards_of(*directory.batch);
    directory.name = fmt::format("{} of {} inputs", directory.batch->command, directory.shards);
    const bool dry_run = invocation.has("dry-run");
    if (!dry_run && request.scheduler != nullptr) require_scheduler(*request.scheduler);
    require_own_folder(directory, "");
    if (fs::exists(directory.merged_file())) {
        write_standard_output(fmt::format("The batch is complete: {}\n", directory.merged_file().string()));
        return ExitCode::success;
    }
    cluster::write_folder(request, "");
    write_standard_output(dry_run ? cluster::planned_request(request) : cluster::submit_request(request));
    return ExitCode::success;
}

}  // namespace

Command batch_command() {
    return {
        .name = "batch",
        .summary = "Run a command on many inputs, on a cluster or on any number of machines.",
        .description =
            "Writes a folder in which `capstan diagnose`, `place` or `sensitivity` runs once for each INPUT, or "
            "`gap-trial` once for each case of a trial, and submits it as `capstan study submit` does: one task for "
            "each input, under a lease, so that any number of workers share the folder and a slow or dead one does "
            "not delay the result. Each answer is kept as the command prints it (JSON), with its SHA-256; the last "
            "worker joins them into results.json, and computes again what is damaged. `capstan study status DIR` "
            "shows the progress, `capstan study work DIR` is a worker. Without --scheduler only the folder is written. "
            "An INPUT that the command refuses has the refusal as its answer. One search over layouts or one screening of "
            "parameters is not divided further: their sums over draws depend on the order; a configuration with "
            "[uncertainty] is, by `capstan study submit`.",
        .arguments =
            {{"COMMAND", "diagnose, gap-trial, place or sensitivity."},
             {"INPUT",
              "A recording, a configuration, or a folder of them; for gap-trial the folder of a trial that "
              "--generate-only made.",
              ArgumentNeed::one_or_more}},
        .options = and_where_it_runs({
            {.name = "with",
             .value = "OPTIONS",
             .meaning = "Options of the command, as --with \"--fit 1,2\"."},
            {.name = "directory",
             .value = "DIR",
             .meaning = "The batch's folder: scripts, answers, logs, and results.json.",
             .default_value = "capstan-batch"},
        }),
        .examples = {"capstan batch diagnose recordings --directory diagnoses",
                     "capstan batch diagnose recordings --scheduler slurm --processors 2 --throttle 100",
                     "capstan batch gap-trial trial --scheduler ssh --hosts node1,node2",
                     "capstan batch place configs --with \"--repetitions 200\" --directory places"},
        .run = run_batch,
        .time =
            "Less than 2 s for some hundred inputs; the work itself is the scheduler's or `capstan study work`'s."};
}

}  // namespace capstan::cli
