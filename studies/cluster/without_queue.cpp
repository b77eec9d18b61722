#include "capstan/cluster/without_queue.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "capstan/cluster/shell_words.h"

namespace capstan::cluster {

namespace {

std::string worker_call(const StudyDirectory& directory) {
    return quoted(directory.program.string()) + " study work " + quoted(directory.path.string()) +
           " --progress none";
}

}  // namespace

std::vector<std::string> ssh_call(const StudyDirectory& directory, const std::string& host) {
    const std::string log = quoted((directory.path / "logs" / ("worker-" + host + ".log")).string());
    return {"ssh", "-o", "BatchMode=yes", host,
            "nohup " + worker_call(directory) + " >> " + log + " 2>&1 < /dev/null &"};
}

std::string parallel_script(const StudyDirectory& directory, const std::vector<std::string>& hosts,
                            int throttle) {
    std::string options;
    if (throttle > 0) options += fmt::format(" --jobs {}", throttle);
    if (!hosts.empty()) options += " --sshlogin " + quoted(fmt::format("{}", fmt::join(hosts, ",")));
    return fmt::format(
        "#!/bin/sh\n# Runs every shard that is not done, then joins them. Safe to run again.\nset -eu\n"
        "cd {}\nseq {} | parallel{} {} \nexec {} --merge\n",
        quoted(directory.path.string()), directory.shards, options,
        quoted(worker_call(directory) + " --shard {} >> " + quoted((directory.path / "logs").string()) +
               "/shard-{}.log 2>&1"),
        worker_call(directory));
}

std::string snakemake_workflow(const StudyDirectory& directory) {
    // A JSON string is one of Python too; braces are Snakemake's.
    std::string call = quoted(directory.program.string());
    for (std::size_t at = 0; (at = call.find_first_of("{}", at)) != std::string::npos; at += 2)
        call.insert(at, 1, call[at]);
    const auto python = [](const std::string& text) { return nlohmann::json(text).dump(); };
    return fmt::format(
        "# snakemake --directory DIR --snakefile DIR/Snakefile --cores all, or --slurm, --cluster, --kubernetes\n"
        "rule study:\n"
        "    input: expand(\"leases/shard-{{shard}}.done\", shard=range(1, {} + 1))\n"
        "    output: \"study.db\"\n"
        "    shell: {}\n\n"
        "rule shard:\n"
        "    output: \"leases/shard-{{shard}}.done\"\n"
        "    log: \"logs/shard-{{shard}}.log\"\n"
        "    threads: {}\n"
        "    shell: {}\n",
        directory.shards, python(call + " study work . --merge --progress none"),
        directory.processors_per_shard,
        python(call + " study work . --shard {wildcards.shard} --progress none >> {log} 2>&1"));
}

}  // namespace capstan::cluster
