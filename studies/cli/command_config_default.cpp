#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/config/config_writer.h"

namespace capstan::cli {

namespace {

ExitCode run_config_default(const Invocation& invocation) {
    deliver(invocation, invocation.has("bench")
                            ? config::config_text(config::default_bench(), config::Comments::every_key)
                            : config::config_text(config::default_plan(), config::Comments::every_key));
    return ExitCode::success;
}

}  // namespace

Command config_default_command() {
    return {
        .name = "config default",
        .summary = "Print a complete configuration with every key explained.",
        .description =
            "Prints a complete configuration: every key with its meaning, unit, limits and default. It "
            "can be run without changes.",
        .options = {{.name = "bench",
                     .kind = OptionKind::flag,
                     .meaning =
                         "Print the configuration of a bench, for `capstan simulate`, instead of a study's."},
                    output_option,
                    help_option},
        .examples = {"capstan config default -o my.toml", "capstan config default --bench -o bench.toml"},
        .run = run_config_default};
}

}  // namespace capstan::cli
