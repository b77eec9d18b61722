// The curves of a diagnosis: what was measured, the model without and with the cause.
#include <fmt/format.h>

#include <algorithm>

#include "capstan/answers/recording_answers.h"

namespace capstan::answers {

namespace {

using gap::Diagnosis;
using reports::Table;

// Of all curves together: each takes about 60 bytes a sample, and the page stays below 3 MB.
constexpr std::size_t drawn_diagnosis_samples = 6000;

constexpr const char* measured_name = "measured";
constexpr const char* nominal_name = "model without the cause";
constexpr const char* corrected_name = "model with the cause";

struct Curves {
    Table channel{
        "channel", "Measured and modelled channels", {"run", "channel", "time_s", "series", "value"}, {}};
    Table residual{
        "channel_residual", "Measured less modelled", {"run", "channel", "time_s", "series", "value"}, {}};
    Table loop{"loop",
               "Load torque over motor torque",
               {"run", "time_s", "series", "motor_torque_Nm", "load_torque_Nm"},
               {}};
    Table condition{
        "condition", "The part of the gap's map that each drawn sample belongs to", {"run", "time_s"}, {}};
    Table part_channel{"part_channel", "The channel of a part of the gap's map", {"part", "channel"}, {}};
};

void add_channel(Curves& curves, const Recording& recording, const Diagnosis& diagnosis, std::size_t run,
                 std::size_t channel, std::size_t limit) {
    const RecordedRun& recorded = recording.runs[run];
    const std::vector<double>& measured = recorded.values[channel];
    const std::vector<double>& nominal = diagnosis.gap.nominal[run].values[channel];
    const std::vector<double>& corrected = diagnosis.gap.leading[run].values[channel];
    const std::string name = drawn_name(recording.channels[channel]);
    const auto number = std::int64_t{recorded.number};
    const std::size_t every = reports::drawn_every(measured.size(), limit);
    for (std::size_t k = 0; k < measured.size(); k += every) {
        const double time_s = recorded.time_s[k];
        curves.channel.rows.push_back({number, name, time_s, measured_name, measured[k]});
        curves.channel.rows.push_back({number, name, time_s, nominal_name, nominal[k]});
        curves.channel.rows.push_back({number, name, time_s, corrected_name, corrected[k]});
        curves.residual.rows.push_back({number, name, time_s, nominal_name, measured[k] - nominal[k]});
        curves.residual.rows.push_back({number, name, time_s, corrected_name, measured[k] - corrected[k]});
    }
}

// Where the load's torque is predicted; the motor's as measured or, where it is predicted, as modelled.
void add_loop(Curves& curves, const Recording& recording, const Diagnosis& diagnosis, std::size_t run,
              std::size_t limit) {
    const auto motor = recording.channel("motor_torque");
    const auto load = recording.channel("load_torque");
    const RecordedRun& recorded = recording.runs[run];
    if (!motor || !load || recorded.drives("load_torque")) return;
    const auto number = std::int64_t{recorded.number};
    const std::size_t every = reports::drawn_every(recorded.time_s.size(), limit);
    for (const auto& [series, model] : {std::pair{measured_name, static_cast<const gap::TwinRun*>(nullptr)},
                                        {nominal_name, &diagnosis.gap.nominal[run]},
                                        {corrected_name, &diagnosis.gap.leading[run]}}) {
        const auto values = [&, model = model](int channel) -> const std::vector<double>& {
            const auto at = static_cast<std::size_t>(channel);
            return model == nullptr || model->values[at].empty() ? recorded.values[at] : model->values[at];
        };
        for (std::size_t k = 0; k < recorded.time_s.size(); k += every)
            curves.loop.rows.push_back(
                {number, recorded.time_s[k], series, values(*motor)[k], values(*load)[k]});
    }
}

void add_conditions(Curves& curves, const Recording& recording, const Diagnosis& diagnosis, std::size_t run,
                    std::size_t limit) {
    const RecordedRun& recorded = recording.runs[run];
    const std::size_t every = reports::drawn_every(recorded.time_s.size(), limit);
    for (std::size_t k = 0; k < recorded.time_s.size(); k += every) {
        auto& row = curves.condition.rows.emplace_back();
        row = {std::int64_t{recorded.number}, recorded.time_s[k]};
        for (const gap::SampleSorting& sorting : diagnosis.gap.sortings) {
            const int part = sorting.part_of[run][k];
            row.emplace_back(part < 0 ? ""
                                      : part_name(sorting.by, sorting.parts[static_cast<std::size_t>(part)]));
        }
    }
}

void add_channels_of_parts(Curves& curves, const Recording& recording) {
    for (const Channel& channel : recording.channels) {
        curves.part_channel.rows.push_back({part_name("channel", channel.name), drawn_name(channel)});
        for (const TensionSensor& sensor : recording.tension_sensors) {
            if (sensor.channel == channel.name)
                curves.part_channel.rows.push_back(
                    {part_name("place", gap::place_part(sensor)), drawn_name(channel)});
        }
    }
}

Curves curves_of(const Recording& recording, const Diagnosis& diagnosis) {
    Curves curves;
    std::size_t modelled = 0;
    for (const gap::TwinRun& run : diagnosis.gap.nominal) {
        modelled += static_cast<std::size_t>(std::count_if(
            run.values.begin(), run.values.end(), [](const auto& values) { return !values.empty(); }));
    }
    const std::size_t limit = drawn_diagnosis_samples / std::max<std::size_t>(1, modelled);
    for (const gap::SampleSorting& sorting : diagnosis.gap.sortings)
        curves.condition.columns.push_back(sorting.by);
    add_channels_of_parts(curves, recording);
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        add_conditions(curves, recording, diagnosis, run, limit);
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            if (!diagnosis.gap.nominal[run].values[channel].empty())
                add_channel(curves, recording, diagnosis, run, channel, limit);
        }
        add_loop(curves, recording, diagnosis, run, limit);
    }
    return curves;
}

}  // namespace

std::vector<Table> diagnosis_curves(const Recording& recording, const Diagnosis& diagnosis) {
    Curves curves = curves_of(recording, diagnosis);
    return {run_table(recording),   std::move(curves.channel),   std::move(curves.residual),
            std::move(curves.loop), std::move(curves.condition), std::move(curves.part_channel)};
}

reports::Table run_table(const Recording& recording) {
    Table table{"run", "Runs of the recording", {"run", "protocol", "samples"}, {}};
    for (const RecordedRun& run : recording.runs)
        table.rows.push_back({std::int64_t{run.number}, run.protocol, std::int64_t{run.samples()}});
    return table;
}

}  // namespace capstan::answers
