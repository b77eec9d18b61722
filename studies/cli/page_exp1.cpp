#include <fmt/format.h>

#include "capstan/cli/paper_pages.h"
#include "capstan/cli/program.h"

namespace capstan::cli {

namespace {

using paper::PaperRamp;
using paper::RampRun;
using reports::NumberTable;
using reports::Table;

using Settings = std::vector<std::vector<RampRun>>;

constexpr std::size_t drawn_samples = 600;  // of a run: every 50 ms, so that ramps keep their corners

Table ramp_table(const Settings& runs) {
    Table table{
        "ramp",
        "Exp. 1 at each pretension",
        {"setting", "pretension_N", "time_s", "motor_torque_Nm", "load_torque_Nm", "ideal_load_torque_Nm"},
        {}};
    for (const auto& setting : runs) {
        for (const RampRun& run : setting) {
            const std::size_t every = reports::drawn_every(run.samples.size(), drawn_samples);
            for (std::size_t k = 0; k < run.samples.size(); k += every) {
                const paper::RampSample& now = run.samples[k];
                table.rows.push_back({run.setting, run.pretension_N, now.time_s, now.motor_torque_Nm,
                                      now.load_torque_Nm, now.ideal_load_torque_Nm});
            }
        }
    }
    return table;
}

// Of the setting that the paper's levels belong to.
Table numbers_table(const std::vector<RampRun>& runs) {
    Table table{
        "ramp_numbers",
        "What each pretension does to the transfer",
        {"pretension_N", "peak_load_torque_Nm", "dead_width_Nm", "lost_transfer_ratio", "rms_to_ideal_Nm"},
        {}};
    for (const RampRun& run : runs) {
        table.rows.push_back({run.pretension_N, run.peak_load_torque_Nm, run.dead_width_Nm,
                              run.lost_transfer_ratio, run.rms_to_ideal_Nm});
    }
    return table;
}

Table paper_table(const std::vector<RampRun>& runs) {
    Table table{"paper_ramp",
                "The paper's four levels, at the pretensions fitted to them",
                {"level", "pretension_N", "implied_peak_load_torque_Nm", "rms_to_ideal_Nm"},
                {}};
    for (std::size_t k = 0; k < paper::papers_ramps().size(); ++k) {
        const PaperRamp& level = paper::papers_ramps()[k];
        table.rows.push_back(
            {level.level, runs[k].pretension_N, level.implied_peak_Nm(), level.rms_to_ideal_Nm});
    }
    return table;
}

std::string milli(double torque_Nm) {
    return fmt::format("{:.0f}", 1e3 * torque_Nm);
}

NumberTable numbers_beside_the_papers(const Settings& runs) {
    NumberTable numbers{"Exp. 1: ours, with the paper's in brackets where it has one",
                        {"Cable", "Pretension [N]", "Peak [mN m]", "Dead width [mN m]", "Lost transfer [%]",
                         "RMS to ideal [mN m]", "Unsolved steps"},
                        {}};
    for (const auto& setting : runs) {
        const bool has_levels = setting.size() == paper::papers_ramps().size();
        for (std::size_t k = 0; k < setting.size(); ++k) {
            const RampRun& run = setting[k];
            std::string peak = milli(run.peak_load_torque_Nm);
            std::string rms = milli(run.rms_to_ideal_Nm);
            if (has_levels) {
                const PaperRamp& level = paper::papers_ramps()[k];
                peak += " (" + milli(level.implied_peak_Nm()) + ")";
                rms += " (" + milli(level.rms_to_ideal_Nm) + ")";
            }
            numbers.rows.push_back({run.setting, fmt::format("{:.1f}", run.pretension_N), peak,
                                    milli(run.dead_width_Nm),
                                    fmt::format("{:.0f}", 1e2 * run.lost_transfer_ratio), rms,
                                    std::to_string(run.unsolved_steps)});
        }
    }
    return numbers;
}

std::string what_the_settings_are() {
    std::string text = "The load is locked, the motor torque ramps between +-0.125 N m.";
    for (const paper::CableSetting& setting : paper::cable_settings())
        text += " Cable " + setting.name + ": " + setting.meaning + ".";
    return text;
}

}  // namespace

reports::ExperimentPage exp1_page(const Settings& runs) {
    const std::vector<RampRun>& reproducing = runs.back();
    reports::ExperimentPage page;
    page.id = "exp1";
    page.kind = "The paper's Exp. 1";
    page.title = "Torque ramps against a locked load";
    page.verdict = fmt::format(
        "More pretension, more friction: from {:.1f} to {:.1f} N of pretension the peak that reaches the load falls "
        "from {:.0f} to {:.0f} mN m, of 650 that an ideal transmission gives.",
        reproducing.front().pretension_N, reproducing.back().pretension_N,
        1e3 * reproducing.front().peak_load_torque_Nm, 1e3 * reproducing.back().peak_load_torque_Nm);
    page.sections = {
        {"ramps", "What reaches the load", what_the_settings_are(), {}, ""},
        {"pretension",
         "What pretension does",
         "Dead width: motor torque that a reversal goes through before the load torque changes. Lost transfer: 1 - "
         "peak / 650 mN m. The paper's peaks follow from its rms errors and their fraction of the peak; its rms to the "
         "ideal is that of its bench, ours of the model.",
         {numbers_beside_the_papers(runs)},
         ""}};
    page.tables = {ramp_table(runs), numbers_table(reproducing), paper_table(reproducing)};
    page.program_version = program_version();
    return page;
}

}  // namespace capstan::cli
