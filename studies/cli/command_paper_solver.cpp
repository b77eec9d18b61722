#include "capstan/answers/paper_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"

namespace capstan::cli {

namespace {

ExitCode run_paper_solver(const Invocation& invocation) {
    std::vector<answers::RatesOfCable> rates;
    for (const int segments : {1, 2, 3, 5, 10, 20, 40, 60}) {
        rates.push_back(
            {segments, paper::race({paper::ComparedMotion::partial, segments, invocation.number("seconds")},
                                   {paper::linear_assumed_peer(), paper::generic_peer()})});
    }
    deliver_answer(invocation, answers::solver_answer(paper::compare_with_generic_solver(), rates));
    return ExitCode::success;
}

}  // namespace

Command paper_solver_command() {
    return {.name = "paper solver",
            .summary = "Repeat the paper's comparison of solvers (Sec. III.B, Fig. 7).",
            .description =
                "Compares the closed-form step with a generic root finder on the same equations, step by "
                "step: the fraction of steps in which the root finder converges and the largest difference "
                "of tension, in mass, partial, mono- and bidirectional motion with 1 to 60 segments. Then "
                "prints steps per second against the number of segments, beside the paper's figures.",
            .options = {{.name = "seconds",
                         .kind = OptionKind::number,
                         .value = "S",
                         .meaning = "Time per solver and number of segments.",
                         .default_value = "0.1",
                         .low = 0.01,
                         .high = 60},
                        output_option,
                        page_option,
                        json_option,
                        help_option},
            .examples = {"capstan paper solver", "capstan paper solver --html solver.html",
                         "capstan paper solver --json -o solver.json"},
            .run = run_paper_solver};
}

}  // namespace capstan::cli
