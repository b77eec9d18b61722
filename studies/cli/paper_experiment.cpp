#include "capstan/cli/paper_experiment.h"

#include "capstan/cli/output.h"

namespace capstan::cli {

const Option trajectories_option = {
    .name = "output",
    .letter = 'o',
    .kind = OptionKind::string,
    .value = "FILE",
    .meaning =
        "Also write the trajectories to FILE as CSV; - writes them to standard output instead of the "
        "table."};

ExitCode deliver_experiment(const Invocation& invocation, const std::string& trajectories_csv,
                            const reports::Answer& answer) {
    deliver_page(invocation, answer);
    if (invocation.has("output")) {
        if (invocation.text("output") == "-") {
            write_standard_output(trajectories_csv);
            return ExitCode::success;
        }
        write_file(invocation.text("output"), trajectories_csv);
    }
    write_standard_output(invocation.has("json") ? reports::answer_json(answer)
                                                 : reports::answer_text(answer));
    return ExitCode::success;
}

}  // namespace capstan::cli
