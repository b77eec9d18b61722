#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/config/config_writer.h"
#include "capstan/platform/statistics.h"

namespace capstan::answers {

namespace {

using estimate::ChannelSet;
using estimate::LeftOutChannel;
using estimate::ModelTrust;
using estimate::SensedCable;
using estimate::SensedRun;
using estimate::TrackedSample;
using reports::Data;
using reports::Table;

// Of all curves together, so that the page stays below 3 MB.
constexpr std::size_t drawn_estimate_samples = 15000;
constexpr std::size_t drawn_along_rows = 24000;
constexpr std::size_t max_drawn_along_samples = 300;  // of one run
constexpr std::size_t max_drawn_nodes = 21;

Table estimate_table() {
    return {"estimate",
            "Readings, estimates and bands",
            {"run", "channel", "time_s", "read_N", "estimate_N", "low_N", "high_N"},
            {}};
}

Table along_table() {
    return {"along",
            "The estimated tension along the cable; in each row also that at its ends",
            {"run", "cable", "time_s", "place_m", "tension_N", "motor_N", "load_N", "load_low_N",
             "load_high_N", "motor_end_m"},
            {}};
}

// What the estimator that reads `used` says at the places of `drawn`.
void draw_channels(Table& table, const SensedCable& cable, const ChannelSet& drawn, double widening,
                   const Cable& cut, const TrackedSample& at) {
    const SensedRun& run = cable.runs[at.run];
    for (const std::size_t channel : drawn) {
        const estimate::SensedChannel& sensed = cable.channels[channel];
        const auto moments = at.at(spot_at(cut, sensed.position_m));
        const double half_N = std::hypot(estimate::band_N(moments, widening), two_sided_95 * sensed.noise_N);
        table.rows.push_back({std::int64_t{run.number},
                              fmt::format("{} at {:.3f} m [N]", sensed.name, sensed.position_m),
                              run.time_s[at.sample], run.reading_N[channel][at.sample], moments.mean_N,
                              moments.mean_N - half_N, moments.mean_N + half_N});
    }
}

// The ends, and so many nodes between them as a map can show.
std::vector<std::size_t> drawn_nodes(std::size_t nodes) {
    const std::size_t shown = std::min(nodes, max_drawn_nodes);
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < shown; ++k)
        chosen.push_back((2 * k * (nodes - 1) + shown - 1) / (2 * (shown - 1)));
    return chosen;
}

// Where no sensor is: at both ends, and at places along the cable.
void draw_along(Table& table, const SensedCable& cable, double widening, const Cable& cut,
                const TrackedSample& at) {
    const SensedRun& run = cable.runs[at.run];
    const auto load = at.at_node(at.nodes() - 1);
    const double half_N = estimate::band_N(load, widening);
    for (const std::size_t node : drawn_nodes(at.nodes())) {
        table.rows.push_back({std::int64_t{run.number}, cable.name, run.time_s[at.sample],
                              cut.node_position_m(static_cast<int>(node)), at.at_node(node).mean_N,
                              at.at_node(0).mean_N, load.mean_N, load.mean_N - half_N, load.mean_N + half_N,
                              run.ends[at.sample].proximal_displacement_m});
    }
}

// `along` may be null.
void draw(Table& table, Table* along, const SensedCable& cable, const ChannelSet& used,
          const ChannelSet& drawn, const ModelTrust& trust, double widening,
          const estimate::TrackingOptions& options, std::size_t limit, std::size_t along_limit) {
    const Cable cut(cable.specification_in(cable.runs.front()));
    track(cable, used, trust, options, [&](const TrackedSample& at) {
        const std::size_t samples = cable.runs[at.run].time_s.size();
        if (at.sample % reports::drawn_every(samples, limit) == 0)
            draw_channels(table, cable, drawn, widening, cut, at);
        if (along != nullptr && at.sample % reports::drawn_every(samples, along_limit) == 0)
            draw_along(*along, cable, widening, cut, at);
    });
}

Data trust_data(const ModelTrust& trust) {
    return {{"wander_m", trust.wander_m}, {"error_ratio", trust.error_ratio}};
}

Data channel_data(const SensedCable& cable, const LeftOutChannel& result) {
    const estimate::SensedChannel& channel = cable.channels[result.channel];
    return {{"channel", channel.name},
            {"cable", cable.name},
            {"position_m", channel.position_m},
            {"noise_N", channel.noise_N},
            {"rms_N", result.rms_N},
            {"coverage", result.coverage},
            {"mean_band_N", result.mean_band_N},
            {"coverage_without_widening", result.plain_coverage},
            {"model_alone_rms_N", result.model_alone_rms_N},
            {"paper_mean_rms_N", result.paper_mean_rms_N},
            {"paper_mean_r_rms_N", result.paper_mean_r_rms_N},
            {"trust", trust_data(result.trust)},
            {"unverified_fraction", result.unverified_fraction},
            {"widening", result.widening_known ? Data(result.widening) : Data()}};
}

reports::Answer answer_about(const Recording& recording) {
    reports::Answer answer{
        .id = "estimate", .kind = "Tension estimated from a recording", .title = recording.name};
    return answer;
}

}  // namespace

reports::Answer left_out_answer(const Recording& recording, const std::vector<LeftOutCable>& results,
                                const estimate::TrackingOptions& options, Figures figures) {
    reports::Answer answer = answer_about(recording);
    answer.values = {{"case", recording.name}, {"channels", Data::list()}};
    Table drawn = estimate_table();
    std::size_t curves = 0;
    for (const LeftOutCable& cable : results) curves += cable.channels.size() * cable.cable->runs.size();
    double min_coverage = 1.0;
    bool all_widened = true;
    for (const LeftOutCable& cable : results) {
        for (const LeftOutChannel& result : cable.channels) {
            const std::size_t one[] = {result.channel};
            if (figures == Figures::drawn)
                draw(drawn, nullptr, *cable.cable, all_but(*cable.cable, one), {result.channel}, result.trust,
                     result.widening, options, drawn_estimate_samples / std::max<std::size_t>(1, curves), 1);
            min_coverage = std::min(min_coverage, result.coverage);
            all_widened = all_widened && result.widening_known;
            answer.values["channels"].push_back(channel_data(*cable.cable, result));
        }
    }
    answer.headline = fmt::format(
        "each channel predicted from the others ({} samples at {:g} Hz). The 95% band holds at least {:.1f}% of the "
        "readings of every channel.",
        recording.samples(), recording.sample_rate_Hz, 1e2 * min_coverage);
    answer.sections = {
        {.id = "runs",
         .heading = "Channels predicted without themselves",
         .tables = {{"channels",
                     "",
                     {{"channel", "channel"},
                      {"position_m", "place", "m", ".3f"},
                      {"noise_N", "noise", "N", ".3f"},
                      {"rms_N", "error", "N", ".3f"},
                      {"coverage", "in band", "", ".1%"},
                      {"mean_band_N", "half width", "N", ".3f"},
                      {"coverage_without_widening", "unwidened", "", ".1%"},
                      {"model_alone_rms_N", "model", "N", ".3f"},
                      {"paper_mean_rms_N", "Mean", "N", ".3f"},
                      {"paper_mean_r_rms_N", "Mean-R", "N", ".3f"}},
                     answer.values["channels"]}},
         .note =
             "Noise: standard deviation of one sample. Error: RMS of reading minus prediction, noise included. In "
             "band: fraction of readings within the 95% band, whose mean half width follows; unwidened: the same "
             "without the model error that predicting the other channels shows. Model: RMS of the model alone, "
             "which reads nothing. Mean, Mean-R: the paper's estimators, each step from their own last "
             "estimate; they give no band."}};
    if (!all_widened) {
        answer.sections.front().note +=
            " Some bands are not widened: with fewer than three channels on a cable, the error of the model cannot "
            "be seen without the channel that is left out.";
    }
    answer.drawn = {run_table(recording), std::move(drawn)};
    return answer;
}

reports::Answer estimate_answer(const Recording& recording, const std::vector<SensedCable>& cables,
                                const std::vector<estimate::EstimatorTuning>& estimates,
                                const estimate::TrackingOptions& options, Figures figures) {
    reports::Answer answer = answer_about(recording);
    answer.headline =
        "the tension from all channels together: at the load, along each cable, and where a sensor can be compared with it.";
    answer.values = {{"case", recording.name}, {"cables", Data::list()}};
    Table drawn = estimate_table();
    Table along = along_table();
    std::size_t curves = 0, maps = 0;
    for (const SensedCable& cable : cables) {
        curves += cable.channels.size() * cable.runs.size();
        maps += cable.runs.size();
    }
    const std::size_t along_samples = std::clamp<std::size_t>(
        drawn_along_rows / (max_drawn_nodes * std::max<std::size_t>(1, maps)), 2, max_drawn_along_samples);
    for (std::size_t c = 0; c < cables.size(); ++c) {
        const ChannelSet all = all_but(cables[c], {});
        if (figures == Figures::drawn)
            draw(drawn, &along, cables[c], all, all, estimates[c].trust, estimates[c].widening, options,
                 drawn_estimate_samples / std::max<std::size_t>(1, curves), along_samples);
        Data channels = Data::list();
        for (const auto& channel : cables[c].channels) channels.push_back(channel.name);
        answer.values["cables"].push_back(
            {{"cable", cables[c].name},
             {"channels", channels},
             {"trust", trust_data(estimates[c].trust)},
             {"wander_um", 1e6 * estimates[c].trust.wander_m},
             {"widening", estimates[c].widening_known ? Data(estimates[c].widening) : Data()}});
    }
    answer.sections = {
        {.id = "along",
         .heading = "Where there is no sensor",
         .prose =
             "The tension at the load with its 95% band, along the cable, and at the load over that at the motor."},
        {.id = "runs",
         .heading = "Estimate from all channels",
         .tables = {{"cables",
                     "How far the model is trusted",
                     {{"cable", "cable"},
                      {"channels", "channels"},
                      {"wander_um", "random motion of an end per sample", "um", ".3g"},
                      {"trust.error_ratio", "model error", "", ".1%"},
                      {"widening", "widening of the band", "", ".1%"}},
                     answer.values["cables"]}},
         .note =
             "Each channel went into the estimate that is drawn over it; `--leave-out each` is the harder test."}};
    answer.drawn = {run_table(recording), std::move(drawn), std::move(along)};
    return answer;
}

std::string model_use_sentence(const bench_model::BenchModel& model,
                               const std::vector<std::string>& not_used) {
    std::string text = fmt::format(
        "The cables are those of the model of {}, and its intervals widen the band.", model.origin.recording);
    if (!not_used.empty())
        text += fmt::format(" The estimator cannot use {} of the model: {}.",
                            not_used.size() == 1 ? "one part" : "these parts", fmt::join(not_used, ", "));
    return text;
}

void add_model_of_estimate(reports::Answer& answer, const bench_model::BenchModel& model,
                           const std::vector<std::string>& not_used) {
    answer.values["model"] = {{"recording", model.origin.recording},
                              {"runs", model.origin.runs},
                              {"verdict", model.origin.verdict},
                              {"not_used", not_used}};
    std::string& prose = answer.sections.back().prose;
    prose += (prose.empty() ? "" : " ") + model_use_sentence(model, not_used);
}

reports::Answer cycle_answer(const StudyPlan& plan, const std::vector<estimate::CycleScore>& scores,
                             int repetitions) {
    reports::Answer answer{
        .id = "cycle",
        .kind = "Layouts scored over the complete motion",
        .title = plan.name,
        .headline = fmt::format(
            "{} scored over {} samples at {:g} Hz, {}, noise {}.", counted(scores.size(), "layout"),
            plan.motion.samples, plan.motion.sample_rate_Hz,
            counted(static_cast<std::size_t>(repetitions), "repetition"), plan.noise_levels.front().label)};
    answer.values = {{"study", plan.name},
                     {"repetitions", repetitions},
                     {"noise", plan.noise_levels.front().label},
                     {"layouts", Data::list()}};
    for (const estimate::CycleScore& score : scores) {
        answer.values["layouts"].push_back({{"family", score.layout.family},
                                            {"nodes", from_one(score.layout.nodes)},
                                            {"error_N", score.error_N},
                                            {"coverage", score.coverage},
                                            {"mean_band_N", score.band_N},
                                            {"wander_m", score.wander_m},
                                            {"paper_mean_error_N", score.paper_mean_N},
                                            {"paper_mean_r_error_N", score.paper_mean_r_N}});
    }
    answer.sections = {
        {.id = "layouts",
         .heading = "Error of each layout",
         .tables = {{"layouts",
                     "",
                     {{"family", "family"},
                      {"nodes", "nodes"},
                      {"error_N", "error", "N", ".3f"},
                      {"coverage", "in band", "", ".1%"},
                      {"mean_band_N", "half width", "N", ".3f"},
                      {"paper_mean_error_N", "Mean", "N", ".3f"},
                      {"paper_mean_r_error_N", "Mean-R", "N", ".3f"}},
                     answer.values["layouts"]}},
         .note =
             "Error: mean absolute error of the recursive estimator over samples, nodes and repetitions. In band: "
             "fraction of tensions within its 95% band, whose mean half width follows. Mean, Mean-R: the paper's "
             "methods, each step from their own last estimate."}};
    answer.config_text = config::config_text(plan, config::Comments::none);
    return answer;
}

}  // namespace capstan::answers
