#include <fmt/format.h>

#include <filesystem>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/cluster/slurm_queue.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"
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

// submission.json last: it marks a complete folder.
void write_folder(const StudyDirectory& directory, const std::string& config_toml) {
    fs::create_directories(directory.path / "logs");
    write_file(directory.config_file(), config_toml);
    write_file(directory.shards_script(), cluster::shards_script(directory));
    write_file(directory.merge_script(), cluster::merge_script(directory));
    write_file(directory.submission_file(), cluster::submission_text(directory));
}

void say_dry_run(const StudyDirectory& directory) {
    std::vector<int> numbers = cluster::shards_to_submit(directory, {});
    write_standard_output(fmt::format(
        "# {}\n{}\n# {}\n{}\n# Not submitted. Without --dry-run:\nsbatch --array={} {}\nsbatch "
        "--dependency=afterok:JOB --kill-on-invalid-dep=yes {}\n",
        directory.shards_script().string(), read_file(directory.shards_script()),
        directory.merge_script().string(), read_file(directory.merge_script()), cluster::as_array(numbers),
        directory.shards_script().string(), directory.merge_script().string()));
}

void submit(const StudyDirectory& directory) {
    const cluster::StudyQueue queue = cluster::read_queue(directory);
    const cluster::Submission done = cluster::submit(directory, queue);
    std::string text;
    if (!done.shards.empty()) {
        text += fmt::format("Submitted shards {} of {} as job {}.\n", cluster::as_array(done.shards),
                            directory.shards, done.array_job);
    }
    if (!queue.shards.empty()) text += fmt::format("In the queue already: {} shards.\n", queue.shards.size());
    if (!done.merge_job.empty()) {
        text +=
            fmt::format("Job {} merges them into {}.\n", done.merge_job, directory.merged_file().string());
    }
    if (text.empty()) text = "Everything is in the queue already.\n";
    write_standard_output(
        text + fmt::format("capstan study status {} shows the progress.\n", directory.path.string()));
}

ExitCode run_study_submit(const Invocation& invocation) {
    if (!invocation.has("slurm")) {
        throw UsageError(
            "capstan study submit: give --slurm; Slurm is the only supported scheduler. Elsewhere run "
            "`capstan study run CONFIG --shard I/N` for each shard, then `capstan study merge`.");
    }
    const config::ReadConfig config = read_config_of(invocation);
    const std::vector<StudyPlan> plans = config::runnable_studies(config);
    StudyDirectory directory;
    directory.path = absolute_directory(invocation.text("directory"));
    directory.name = config.plan.name;
    directory.shards = static_cast<int>(invocation.integer("shards"));
    directory.processors_per_shard = static_cast<int>(invocation.integer("processors"));
    directory.program = fs::read_symlink("/proc/self/exe");
    if (config.plan.uncertainty.is_stated) {
        require_one_of_worlds(plans);
        require_worlds_for(plans.front(), directory.shards);
    } else {
        require_useful(plans, {1, directory.shards});
    }
    const bool dry_run = invocation.has("dry-run");
    if (!dry_run && !cluster::slurm_is_there()) {
        throw UsageError(
            "capstan study submit: sbatch and squeue are not on PATH, so there is no Slurm here. Run "
            "this on a machine of the cluster, or use --dry-run to see what would be submitted.");
    }
    require_own_folder(directory, config::config_text(config.plan, config::Comments::none));
    if (fs::exists(directory.merged_file())) {
        write_standard_output(fmt::format(
            "{} is complete; nothing to submit. `capstan recommend --db {}` shows the recommendation.\n",
            directory.name, directory.merged_file().string()));
        return ExitCode::success;
    }
    write_folder(directory, config::config_text(config.plan, config::Comments::none));
    if (dry_run) {
        say_dry_run(directory);
    } else {
        submit(directory);
    }
    return ExitCode::success;
}

}  // namespace

Command study_submit_command() {
    return {.name = "study submit",
            .summary = "Run a study on a cluster, in shards.",
            .description =
                "Writes a folder with the files that Slurm needs to run CONFIG in shards: an array job with "
                "one task per shard, and a job that merges the shards when all are done. Submits both jobs "
                "with sbatch. Slurm schedules the tasks and restarts those of a failed node; a restarted "
                "task continues where it stopped. Running the command again submits only the shards that are "
                "neither done nor in the queue. All machines must see the folder and this program under the "
                "same path. Partition, account and time limit are options of sbatch: set SBATCH_PARTITION, "
                "SBATCH_ACCOUNT, SBATCH_TIMELIMIT.",
            .arguments = {config_argument},
            .options = {{.name = "slurm", .kind = OptionKind::flag, .meaning = "Submit to Slurm."},
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
                        {.name = "dry-run",
                         .kind = OptionKind::flag,
                         .meaning = "Write the folder and print the scripts, but submit nothing."},
                        seed_option,
                        repetitions_option,
                        help_option},
            .examples = {"capstan study submit --slurm configs/atlas.toml --shards 100 --directory atlas",
                         "SBATCH_PARTITION=long capstan study submit --slurm my.toml"},
            .run = run_study_submit};
}

}  // namespace capstan::cli
