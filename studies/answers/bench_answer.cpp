#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/answers/paper_answers.h"
#include "capstan/cable/cable_cut.h"
#include "capstan/config/config_writer.h"

namespace capstan::answers {

namespace {

using bench::BenchInstant;
using reports::Data;

constexpr std::size_t drawn_curve_samples = 1500;
constexpr std::size_t drawn_profiles = 110;  // columns of the tension maps
constexpr std::size_t drawn_snapshots = 5;   // instants drawn as curves
constexpr int drawn_positions = 25;          // rows of the tension maps
constexpr double slack_N = 1e-9;             // tension of a slack cable is zero but for rounding

std::vector<int> spread_nodes(int nodes) {
    const int drawn = std::min(nodes, drawn_positions);
    std::vector<int> spread;
    for (int k = 0; k < drawn; ++k)
        spread.push_back(drawn == 1 ? 0 : static_cast<int>(std::lround(k * (nodes - 1.0) / (drawn - 1.0))));
    return spread;
}

double smallest(const std::vector<double>& tension_N) {
    return *std::min_element(tension_N.begin(), tension_N.end());
}

}  // namespace

BenchAnswer::BenchAnswer(const bench::BenchPlan& plan)
    : plan_(plan),
      ideal_ratio_(plan.pulleys.load_radius_m / plan.pulleys.motor_radius_m),
      drawn_nodes_(spread_nodes(plan.cable.segments + 1)),
      curve_every_(reports::drawn_every(plan.samples() + 1, drawn_curve_samples)),
      profile_every_(reports::drawn_every(plan.samples() + 1, drawn_profiles)),
      snapshot_every_(profile_every_ * reports::drawn_every(drawn_profiles, drawn_snapshots)),
      angle_{"angle", "Angles of both pulleys", {"time_s", "series", "angle_deg"}, {}},
      torque_{"torque", "Torques over time", {"time_s", "series", "torque_Nm"}, {}},
      transfer_{"transfer",
                "Load torque over motor torque",
                {"time_s", "motor_torque_Nm", "load_torque_Nm", "ideal_load_torque_Nm"},
                {}},
      profile_{"profile",
               "Tension along both cables over time",
               {"time_s", "until_s", "cable", "position_m", "until_m", "tension_N", "slack"},
               {}},
      snapshot_{"snapshot",
                "Tension along both cables at a few instants",
                {"instant", "time_s", "cable", "position_m", "tension_N"},
                {}},
      min_a_N_(plan.cable.pretension_N),
      min_b_N_(plan.cable.pretension_N) {}

void BenchAnswer::add(const BenchInstant& now) {
    count(now);
    if (sample_ % curve_every_ == 0) add_curves(now);
    if (sample_ % profile_every_ == 0) add_tensions(now);
    ++sample_;
}

void BenchAnswer::count(const BenchInstant& now) {
    peak_load_torque_Nm_ = std::max(peak_load_torque_Nm_, std::abs(now.load_torque_Nm));
    peak_motor_torque_Nm_ = std::max(peak_motor_torque_Nm_, std::abs(now.motor_torque_Nm));
    const double min_a_N = smallest(now.tension_a_N);
    const double min_b_N = smallest(now.tension_b_N);
    min_a_N_ = std::min(min_a_N_, min_a_N);
    min_b_N_ = std::min(min_b_N_, min_b_N);
    if (std::min(min_a_N, min_b_N) <= slack_N) ++slack_samples_;
    if (!now.solved) ++unsolved_;
}

void BenchAnswer::add_curves(const BenchInstant& now) {
    const double ideal_Nm = ideal_ratio_ * now.motor_torque_Nm;
    angle_.rows.push_back({now.time_s, "motor", degrees(now.motor_angle_rad)});
    angle_.rows.push_back({now.time_s, "load", degrees(now.load_angle_rad)});
    torque_.rows.push_back({now.time_s, "motor", now.motor_torque_Nm});
    torque_.rows.push_back({now.time_s, "load", now.load_torque_Nm});
    torque_.rows.push_back({now.time_s, "load, ideal transmission", ideal_Nm});
    transfer_.rows.push_back({now.time_s, now.motor_torque_Nm, now.load_torque_Nm, ideal_Nm});
}

void BenchAnswer::add_tensions(const BenchInstant& now) {
    const double segment_m = length_m(plan_.cable.curvature) / plan_.cable.segments;
    const double until_s = now.time_s + static_cast<double>(profile_every_) / plan_.sample_rate_Hz;
    for (const auto& [cable, tension_N] :
         {std::pair{"cable A", &now.tension_a_N}, std::pair{"cable B", &now.tension_b_N}}) {
        for (std::size_t k = 0; k < drawn_nodes_.size(); ++k) {
            const int node = drawn_nodes_[k];
            const double here_N = (*tension_N)[static_cast<std::size_t>(node)];
            if (k + 1 < drawn_nodes_.size()) {
                profile_.rows.push_back({now.time_s, until_s, cable, node * segment_m,
                                         drawn_nodes_[k + 1] * segment_m, here_N,
                                         std::int64_t{here_N <= slack_N ? 1 : 0}});
            }
            if (sample_ % snapshot_every_ == 0) {
                snapshot_.rows.push_back(
                    {fmt::format("{:.3g} s", now.time_s), now.time_s, cable, node * segment_m, here_N});
            }
        }
    }
}

std::string BenchAnswer::conditions() const {
    const std::vector<std::string> effects = effects_there(plan_.effects);
    std::string text = fmt::format("{} segments to a cable, {} samples at {:.4g} Hz", plan_.cable.segments,
                                   plan_.samples(), plan_.sample_rate_Hz);
    if (effects.empty()) return text + ", by the closed-form step.";
    text += ", with effects:";
    for (const std::string& effect : effects) text += " " + effect + (&effect == &effects.back() ? "." : ",");
    return text;
}

std::string BenchAnswer::headline() const {
    const std::string text = fmt::format(
        "the motor torque reaches {:.3g} N m and the load torque {:.3g} N m; an ideal transmission would give {:.3g} "
        "N m.",
        peak_motor_torque_Nm_, peak_load_torque_Nm_, ideal_ratio_ * peak_motor_torque_Nm_);
    if (slack_samples_ == 0) return text + " Both cables stay taut.";
    return text + fmt::format(" A cable is slack, at least at one end, in {:.0f}% of the samples.",
                              1e2 * static_cast<double>(slack_samples_) / static_cast<double>(sample_));
}

reports::Answer BenchAnswer::finished() const {
    reports::Answer answer{
        .id = "bench", .kind = "A simulated bench", .title = plan_.name, .headline = headline()};
    Data rows = Data::list();
    const auto add = [&](const char* quantity, Data value, const char* unit) {
        rows.push_back({{"quantity", quantity}, {"value", std::move(value)}, {"unit", unit}});
    };
    add("largest motor torque", peak_motor_torque_Nm_, "N m");
    add("largest load torque", peak_load_torque_Nm_, "N m");
    add("smallest tension in cable A", min_a_N_, "N");
    add("smallest tension in cable B", min_b_N_, "N");
    add("samples with slack in a cable", slack_samples_, "");
    add("steps unsolved", unsolved_, "");
    answer.values = {{"name", plan_.name}, {"numbers", rows}};
    answer.sections = {
        {.id = "motion",
         .heading = "Input and output",
         .prose = conditions(),
         .tables = {{"numbers",
                     "Over all samples",
                     {{"quantity", "quantity"}, {"value", "value"}, {"unit", "unit"}},
                     rows}}},
        {.id = "tension",
         .heading = "Tension inside the cables",
         .prose =
             "Tension from the motor end (0 m) to the load end. A slack cable is marked in orange: it carries "
             "nothing, its friction history is erased, and the other cable pulls alone."}};
    answer.drawn = {angle_, torque_, transfer_, profile_, snapshot_};
    answer.config_text = config::config_text(plan_, config::Comments::none);
    return answer;
}

}  // namespace capstan::answers
