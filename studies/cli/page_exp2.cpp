#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "capstan/cli/paper_pages.h"
#include "capstan/cli/program.h"
#include "capstan/cli/viscous_answer.h"

namespace capstan::cli {

namespace {

using paper::TunnelRun;
using paper::ViscousComparison;
using reports::NumberTable;
using reports::Table;

constexpr paper::PaperTunnel papers_tunnel;
constexpr paper::PaperViscous papers_viscous;
constexpr std::size_t drawn_samples = 500;  // of a run: more than a panel has pixels for

double degrees(double angle_rad) {
    return angle_rad * 180.0 / std::numbers::pi;
}

// The second period of each run: the first begins at rest.
Table loop_table(const std::vector<std::vector<TunnelRun>>& runs) {
    Table table{"tunnel_loop",
                "Exp. 2, second period of the handle's motion",
                {"setting", "pretension_N", "time_s", "load_angle_deg", "motor_torque_Nm", "load_torque_Nm",
                 "ideal_load_torque_Nm"},
                {}};
    for (const auto& setting : runs) {
        for (const TunnelRun& run : setting) {
            const std::size_t period = run.samples.size() / 2;
            const std::size_t every = reports::drawn_every(period, drawn_samples);
            for (std::size_t k = period; k < run.samples.size(); k += every) {
                const paper::TunnelSample& now = run.samples[k];
                table.rows.push_back({run.setting, run.pretension_N, now.time_s, degrees(now.load_angle_rad),
                                      now.motor_torque_Nm, now.load_torque_Nm, now.ideal_load_torque_Nm});
            }
        }
    }
    return table;
}

struct Series {
    const char* name;
    double paper::ViscousSample::*torque_Nm;
};
constexpr Series without_term{"model without viscous friction", &paper::ViscousSample::without_term_Nm};
constexpr Series with_term{"model with viscous friction, fitted", &paper::ViscousSample::with_term_Nm};
constexpr Series bench{"bench (simulated)", &paper::ViscousSample::bench_torque_Nm};

Table viscous_loop_table(const ViscousComparison& viscous) {
    Table table{"viscous_loop",
                "Exp. 2 on the simulated bench and of both models, second period",
                {"series", "time_s", "load_angle_deg", "motor_torque_Nm", "load_torque_Nm"},
                {}};
    const std::size_t period = viscous.samples.size() / 2;
    const std::size_t every = reports::drawn_every(period, drawn_samples);
    for (const Series& series : {bench, without_term, with_term}) {
        for (std::size_t k = period; k < viscous.samples.size(); k += every) {
            const paper::ViscousSample& now = viscous.samples[k];
            table.rows.push_back({series.name, now.time_s, degrees(now.load_angle_rad), now.motor_torque_Nm,
                                  now.*series.torque_Nm});
        }
    }
    return table;
}

Table residual_table(const ViscousComparison& viscous) {
    Table table{"residual",
                "Residual of the load torque over the handle's velocity, both periods",
                {"series", "load_speed_rad_per_s", "residual_Nm"},
                {}};
    const std::size_t every = reports::drawn_every(viscous.samples.size(), 2 * drawn_samples);
    for (const Series& series : {without_term, with_term}) {
        for (std::size_t k = 0; k < viscous.samples.size(); k += every) {
            const paper::ViscousSample& now = viscous.samples[k];
            table.rows.push_back(
                {series.name, now.load_speed_rad_per_s, now.bench_torque_Nm - now.*series.torque_Nm});
        }
    }
    return table;
}

Table line_table(const ViscousComparison& viscous) {
    Table table{"residual_line",
                "Linear fits of the residual",
                {"series", "load_speed_rad_per_s", "residual_Nm"},
                {}};
    double fastest = 0.0;
    for (const auto& now : viscous.samples) fastest = std::max(fastest, std::abs(now.load_speed_rad_per_s));
    const auto add = [&](const Series& series, const paper::ResidualLine& line) {
        for (const double speed : {-fastest, fastest})
            table.rows.push_back({series.name, speed, line.offset_Nm + line.slope_Nm_s_per_rad * speed});
    };
    add(without_term, viscous.without_term);
    add(with_term, viscous.with_term);
    return table;
}

NumberTable tunnel_numbers(const std::vector<std::vector<TunnelRun>>& runs) {
    NumberTable numbers{
        "Exp. 2: load torque, and the loop of one period of 10 s",
        {"Cable", "Pretension [N]", "Peak [N m]", "RMS to ideal [N m]", "RMS by peak [%]", "Loop area [J]",
         "Unsolved steps"},
        {{"paper (bench)", "not given", fmt::format("{:.2f}", papers_tunnel.implied_peak_Nm()),
          fmt::format("{:.3f}", papers_tunnel.rms_to_ideal_Nm),
          fmt::format("{:.1f}", 1e2 * papers_tunnel.rms_to_ideal_by_peak), "not given", ""}}};
    for (const auto& setting : runs) {
        for (const TunnelRun& run : setting) {
            numbers.rows.push_back(
                {run.setting, fmt::format("{:.1f}", run.pretension_N),
                 fmt::format("{:.2f}", run.peak_load_torque_Nm), fmt::format("{:.3f}", run.rms_to_ideal_Nm),
                 fmt::format("{:.1f}", 1e2 * run.rms_to_ideal_Nm / run.peak_load_torque_Nm),
                 fmt::format("{:.2f}", run.loop_work_J), std::to_string(run.unsolved_steps)});
        }
    }
    return numbers;
}

NumberTable viscous_numbers(const ViscousComparison& viscous) {
    const auto row = [](const char* name, const paper::ResidualLine& line, const std::string& drag) {
        return std::vector<std::string>{name, drag, fmt::format("{:.1f}", line.sum_of_squares_Nm2),
                                        fmt::format("{:.3f}", line.rms_Nm),
                                        fmt::format("{:.4f}", line.slope_Nm_s_per_rad)};
    };
    const auto& with = viscous.with_term;
    return {
        fmt::format("Residual of the load torque. The term takes {:.0f}% of the sum of squares; the paper "
                    "says about {:.0f}%",
                    1e2 * viscous.reduction(), 1e2 * papers_viscous.reduction),
        {"Model", "Drag [N s/m2]", "Sum of squares [N2m2]", "RMS [N m]", "Slope [N m s/rad]"},
        {{"paper, without viscous friction", "0", "not given",
          fmt::format("{:.3f}", papers_viscous.rms_without_term_Nm), "not given"},
         row("without viscous friction", viscous.without_term, "0"),
         row("with it, fitted", with,
             fmt::format("{:.2f} (put in: {:.2f})", viscous.fitted_drag_N_s_per_m2,
                         viscous.bench.drag_N_s_per_m2))}};
}

}  // namespace

reports::ExperimentPage exp2_page(const std::vector<std::vector<TunnelRun>>& runs,
                                  const ViscousComparison& viscous) {
    reports::ExperimentPage page;
    page.id = "exp2";
    page.kind = "The paper's Exp. 2";
    page.title = "An error-reduction tunnel under a moving hand";
    page.verdict = fmt::format(
        "Friction along the cables makes a loop of the tunnel that the motor renders: the load feels up to {:.2f} N m "
        "where an ideal transmission gives {:.2f} (paper's bench: about {:.1f}).",
        runs.back().back().peak_load_torque_Nm, runs.back().back().ideal_peak_load_torque_Nm,
        papers_tunnel.implied_peak_Nm());
    page.sections = {
        {"loops",
         "The loop that friction makes",
         "A hand moves the handle 40 deg peak to peak; the motor torque follows from the load angle by the paper's "
         "(7). The paper does not print its participant's motion: ours is a sum of three sines.",
         {tunnel_numbers(runs)},
         ""},
        {"viscous",
         "With and without viscous friction",
         viscous_caveat(viscous),
         {viscous_numbers(viscous)},
         ""},
    };
    page.tables = {loop_table(runs), viscous_loop_table(viscous), residual_table(viscous),
                   line_table(viscous)};
    page.program_version = program_version();
    return page;
}

}  // namespace capstan::cli
