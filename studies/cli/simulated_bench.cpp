#include "capstan/cli/simulated_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "capstan/bench/bench_run.h"
#include "capstan/cli/output.h"
#include "capstan/cli/page_bench.h"
#include "capstan/config/config_reader.h"

namespace capstan::cli {

namespace {

using bench::BenchInstant;

std::string head_line(int nodes, bool with_tensions) {
    std::string line =
        "time_s,motor_torque_Nm,motor_angle_rad,load_torque_Nm,load_angle_rad,solved,min_tension_a_N,"
        "min_tension_b_N";
    for (const char cable : {'a', 'b'}) {
        for (int node = 1; with_tensions && node <= nodes; ++node)
            line += fmt::format(",tension_{}_{}_N", cable, node);
    }
    return line + "\n";
}

double least(const std::vector<double>& tension_N) {
    return *std::min_element(tension_N.begin(), tension_N.end());
}

void append_line(std::string& text, const BenchInstant& now, bool with_tensions) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{},{},{},{},{},{},{},{}", now.time_s, now.motor_torque_Nm, now.motor_angle_rad,
                   now.load_torque_Nm, now.load_angle_rad, now.solved ? 1 : 0, least(now.tension_a_N),
                   least(now.tension_b_N));
    for (const auto* cable : {&now.tension_a_N, &now.tension_b_N}) {
        for (std::size_t node = 0; with_tensions && node < cable->size(); ++node)
            fmt::format_to(out, ",{}", (*cable)[node]);
    }
    text += "\n";
}

}  // namespace

ExitCode simulate_bench_file(const Invocation& invocation) {
    const bench::BenchPlan plan = config::read_bench(invocation.argument("CONFIG")).plan;
    const bool with_tensions = invocation.has("tensions");
    std::string text = head_line(plan.cable.segments + 1, with_tensions);
    BenchPage page(plan);
    bench::simulate_bench(plan, [&](const BenchInstant& now) {
        append_line(text, now, with_tensions);
        page.add(now);
    });
    deliver_page(invocation, [&] { return reports::experiment_page_html(page.finished()); });
    deliver(invocation, text);
    return ExitCode::success;
}

}  // namespace capstan::cli
