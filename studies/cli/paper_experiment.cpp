#include "capstan/cli/paper_experiment.h"

#include "capstan/cli/output.h"

namespace capstan::cli {

const Option trajectories_option = {
    "output",
    'o',
    OptionKind::text,
    "FILE",
    "Also write the trajectories to FILE, as CSV; - writes them to standard output, and no table.",
    ""};

ExitCode deliver_experiment(const Invocation& invocation, const std::string& trajectories_csv,
                            const std::string& answer) {
    if (invocation.has("output")) {
        if (invocation.text("output") == "-") {
            write_standard_output(trajectories_csv);
            return ExitCode::success;
        }
        write_file(invocation.text("output"), trajectories_csv);
    }
    write_standard_output(answer);
    return ExitCode::success;
}

}  // namespace capstan::cli
