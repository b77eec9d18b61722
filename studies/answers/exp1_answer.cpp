#include <fmt/format.h>

#include "capstan/answers/paper_answers.h"
#include "capstan/reports/plain_tables.h"

namespace capstan::answers {

namespace {

using paper::PaperRamp;
using paper::RampRun;
using reports::Data;
using reports::Table;

using Settings = std::vector<std::vector<RampRun>>;

constexpr std::size_t drawn_ramp_samples = 600;  // of a run: every 50 ms, so that ramps keep their corners

// The paper's four levels belong to a setting of as many pretensions.
const PaperRamp* papers_level(const std::vector<RampRun>& setting, std::size_t level) {
    return setting.size() == paper::papers_ramps().size() ? &paper::papers_ramps()[level] : nullptr;
}

Data runs_data(const Settings& runs) {
    Data rows = Data::list();
    for (const auto& setting : runs) {
        for (std::size_t k = 0; k < setting.size(); ++k) {
            const RampRun& run = setting[k];
            Data row = {{"setting", run.setting},
                        {"pretension_N", run.pretension_N},
                        {"peak_load_torque_Nm", run.peak_load_torque_Nm},
                        {"dead_width_Nm", run.dead_width_Nm},
                        {"lost_transfer_ratio", run.lost_transfer_ratio},
                        {"rms_to_ideal_Nm", run.rms_to_ideal_Nm},
                        {"unsolved_steps", run.unsolved_steps}};
            if (const PaperRamp* level = papers_level(setting, k)) {
                row["paper"] = {{"level", level->level},
                                {"implied_peak_load_torque_Nm", level->implied_peak_Nm()},
                                {"rms_to_ideal_Nm", level->rms_to_ideal_Nm},
                                {"rms_of_model_Nm", level->rms_of_model_Nm},
                                {"fraction_of_peak", level->fraction_of_peak}};
            }
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

Table ramp_table(const Settings& runs) {
    Table table{
        "ramp",
        "Exp. 1 at each pretension",
        {"setting", "pretension_N", "time_s", "motor_torque_Nm", "load_torque_Nm", "ideal_load_torque_Nm"},
        {}};
    for (const auto& setting : runs) {
        for (const RampRun& run : setting) {
            const std::size_t every = reports::drawn_every(run.samples.size(), drawn_ramp_samples);
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

std::string what_the_settings_are() {
    std::string text = "The load is locked, the motor torque ramps between +-0.125 N m.";
    for (const paper::CableSetting& setting : paper::cable_settings())
        text += " Cable " + setting.name + ": " + setting.meaning + ".";
    return text;
}

Data range_data(const paper::TorqueRange& range) {
    return Data::list({range.low_Nm, range.high_Nm});
}

Data readings_data(const std::vector<paper::ReadingResult>& results) {
    Data rows = Data::list();
    for (const paper::ReadingResult& result : results) {
        Data row = {{"reading", result.reading.name},
                    {"peak_motor_torque_Nm", result.reading.peak_motor_torque_Nm},
                    {"radius_ratio", result.reading.radius_ratio},
                    {"ideal_peak_Nm", result.reading.ideal_peak_Nm()},
                    {"bend_radius_m", result.bend_radius_m},
                    {"reproduces_all", result.reproduces_all()}};
        for (std::size_t k = 0; k < result.levels.size(); ++k) {
            const paper::ReadAtLevel& level = result.levels[k];
            row[paper::papers_ramps()[k].level] = {
                {"rms_to_ideal_Nm", level.rms_to_ideal_Nm ? Data(*level.rms_to_ideal_Nm) : Data()},
                {"paper_Nm", level.paper_Nm},
                {"tolerance_Nm", level.tolerance_Nm},
                {"reproduced", level.reproduced()}};
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

reports::AnswerSection readings_section(const paper::RampReadings& readings, const Data& rows) {
    std::vector<reports::Column> columns = {{"reading", "reading"},
                                            {"ideal_peak_Nm", "ideal peak", "N m", ".3f"},
                                            {"bend_radius_m", "bend radius", "m", ".2f"}};
    for (const PaperRamp& level : paper::papers_ramps()) {
        columns.push_back(
            {level.level + ".rms_to_ideal_Nm",
             fmt::format("{} ({:.3f} +- {:.3f})", level.level, level.rms_to_ideal_Nm, level.rms_of_model_Nm),
             "N m", ".3f"});
    }
    columns.push_back({"reproduces_all", "reproduces all"});
    return {
        .id = "readings",
        .heading = "Which torque the paper's rms errors belong to",
        .prose = fmt::format(
            "The paper gives the rms error of the ideal transmission at four pretensions. Printed torque and ratio "
            "cannot give them, with any friction: the ideal torque alone then has an rms of 433 mN m, and a load torque "
            "of at most 46 mN m (the highest pretension) brings its distance to 387 mN m at best, not to 322. Each "
            "reading below takes the pretensions at which the peaks are the paper's, and the bend radius that comes "
            "nearest. All four come out where the ideal peak load torque is {:.2f} to {:.2f} N m ({:.2f} to {:.2f} N m "
            "if the dwells do not count), not 0.65: with a peak torque of about 0.1 N m, or a smaller ratio. Which of "
            "them the paper's bench had is unknown.",
            readings.reproducing.low_Nm, readings.reproducing.high_Nm,
            readings.reproducing_without_dwells.low_Nm, readings.reproducing_without_dwells.high_Nm),
        .tables = {{"readings", "", std::move(columns), rows}},
        .note =
            "In brackets: the paper's rms error of the ideal transmission, and the tolerance, which is the rms error of "
            "the paper's model. By the triangle inequality the rms to the ideal of a model that is as near to the bench "
            "cannot differ more from that of the bench. -: no pretension has the paper's peak with any bend radius."};
}

}  // namespace

std::string trajectories_csv(const std::vector<std::vector<paper::RampRun>>& runs) {
    std::string text = reports::csv_head({"setting", "pretension_N", "time_s", "motor_torque_Nm",
                                          "motor_angle_rad", "load_torque_Nm", "ideal_load_torque_Nm"});
    for (const auto& setting : runs) {
        for (const paper::RampRun& run : setting) {
            for (const auto& sample : run.samples)
                text += reports::csv_line({run.setting, run.pretension_N, sample.time_s,
                                           sample.motor_torque_Nm, sample.motor_angle_rad,
                                           sample.load_torque_Nm, sample.ideal_load_torque_Nm});
        }
    }
    return text;
}

reports::Answer exp1_answer(const Settings& runs, const paper::RampReadings& readings) {
    const std::vector<RampRun>& reproducing = runs.back();
    reports::Answer answer{
        .id = "exp1",
        .kind = "The paper's Exp. 1",
        .title = "Torque ramps against a locked load",
        .headline = fmt::format(
            "more pretension means more friction: from {:.1f} to {:.1f} N of pretension the peak load torque falls from "
            "{:.0f} to {:.0f} mN m, while an ideal transmission gives 650 mN m.",
            reproducing.front().pretension_N, reproducing.back().pretension_N,
            1e3 * reproducing.front().peak_load_torque_Nm, 1e3 * reproducing.back().peak_load_torque_Nm)};
    answer.values = {
        {"experiment", "exp1"},
        {"runs", runs_data(runs)},
        {"readings", readings_data(readings.results)},
        {"reproducing_ideal_peak_Nm", range_data(readings.reproducing)},
        {"reproducing_ideal_peak_without_dwells_Nm", range_data(readings.reproducing_without_dwells)}};
    answer.sections = {
        {.id = "ramps", .heading = "Torque that reaches the load", .prose = what_the_settings_are()},
        {.id = "pretension",
         .heading = "Effect of the pretension",
         .tables = {{"runs",
                     "",
                     {{"setting", "cable"},
                      {"pretension_N", "pretension", "N", ".1f"},
                      {"peak_load_torque_Nm", "peak", "N m", ".3f"},
                      {"paper.implied_peak_load_torque_Nm", "paper's", "N m", ".3f"},
                      {"dead_width_Nm", "dead width", "N m", ".3f"},
                      {"lost_transfer_ratio", "lost transfer", "", ".0%"},
                      {"rms_to_ideal_Nm", "RMS to ideal", "N m", ".3f"},
                      {"paper.rms_to_ideal_Nm", "paper's", "N m", ".3f"},
                      {"unsolved_steps", "unsolved steps"}},
                     answer.values["runs"]}},
         .note =
             "Dead width: motor torque that passes after a reversal before the load torque changes (0.25 N m is the "
             "complete ramp). Lost transfer: 1 - peak / 650 mN m of the ideal transmission. The paper's peaks "
             "follow from its rms errors and their fraction of the peak; its rms to the ideal is that of its "
             "bench, ours that of the model."},
        readings_section(readings, answer.values["readings"])};
    answer.drawn = {ramp_table(runs), numbers_table(reproducing), paper_table(reproducing)};
    return answer;
}

}  // namespace capstan::answers
