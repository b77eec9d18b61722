#include "capstan/suggestion/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/importer.h"
#include "capstan/import/log_files.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/rig/channel_names.h"
#include "capstan/suggestion/column_motion.h"
#include "capstan/suggestion/column_roles.h"
#include "capstan/suggestion/guessed_signs.h"
#include "capstan/suggestion/guessed_times.h"
#include "capstan/suggestion/guessed_units.h"

namespace capstan::imports {

namespace {

constexpr double fits_by_name = 0.5;
/// Builds a suggestion step by step.
class Suggesting {
  public:
    Suggesting(const std::vector<std::filesystem::path>& files, const SuggestOptions& options)
        : files_(files), options_(options) {
        logs::ReadOptions reading;
        reading.text = options.text;
        const auto on_read = [&](double part) {
            if (options.on_progress) options.on_progress("reading", part);
        };
        logs_ = read_logs(files, reading, on_read);
        suggestion_.mapping.file = "the suggestion";
        suggestion_.mapping.text = options.text;
    }

    Suggestion suggested() {
        // The logs of several runs have the same columns; topics in several files are one run.
        std::vector<const logs::Log*> looked_at = {logs_.front().get()};
        if (!same_columns()) {
            for (std::size_t file = 1; file < logs_.size(); ++file) looked_at.push_back(logs_[file].get());
        }
        columns_ = seen_columns(looked_at);
        times_ = guess_times(suggestion_.mapping.time, columns_, suggestion_.guesses);
        find_run_numbers();
        find_channels();
        find_kind();
        guess_signs(suggestion_.mapping, chosen_, suggestion_.guesses);
        for (std::size_t file = 0; same_columns() && file < files_.size(); ++file) {
            RunMapping& run = suggestion_.mapping.runs.emplace_back();
            run.files = {files_[file].filename().string()};
        }
        try_it();
        return std::move(suggestion_);
    }

  private:
    void guess(const std::string& about, Doubt doubt, const std::string& reason) {
        suggestion_.guesses.push_back({about, doubt, reason});
    }

    bool same_columns() const {
        return std::all_of(logs_.begin(), logs_.end(), [&](const auto& log) {
            return column_names(*log) == column_names(*logs_.front());
        });
    }

    void find_run_numbers() {
        for (const SeenColumn& column : columns_) {
            if (times_.count(column.column) > 0 || !is_run_number(column)) continue;
            used_.insert(&column);
            suggestion_.mapping.run_column = column.column->name;
            return guess(
                "time", Doubt::likely,
                fmt::format("\"{}\" numbers the runs, by its name and its few changes", column.column->name));
        }
    }

    const SeenColumn* best_by_name(const std::string& channel, double& margin) const {
        const SeenColumn* best = nullptr;
        double first = 0.0;
        double second = 0.0;
        for (const SeenColumn& column : columns_) {
            if (times_.count(column.column) > 0 || used_.count(&column) > 0) continue;
            const double fit = name_fits(column, channel);
            if (fit > first) {
                second = first;
                first = fit;
                best = &column;
            } else {
                second = std::max(second, fit);
            }
        }
        margin = first - second;
        return first >= fits_by_name ? best : nullptr;
    }

    void find_channels() {
        for (const char* name :
             {channel::motor_angle, channel::load_angle, channel::motor_torque, channel::load_torque}) {
            double margin = 0.0;
            const SeenColumn* column = best_by_name(name, margin);
            if (column == nullptr) continue;
            used_.insert(column);
            add_channel(name, *column);
            guess(name, margin > 0.15 ? Doubt::likely : Doubt::doubtful,
                  fmt::format("the name \"{}\" fits{}", column->column->name,
                              margin > 0.15 ? "" : "; another column fits nearly as well"));
        }
        find_tensions();
        if (chosen_.size() < 2) find_by_motion();
        if (chosen_.empty())
            throw InvalidInput({fmt::format(
                "{}: no column looks like an angle, a torque or a tension; write the mapping by hand "
                "(`capstan import --help` shows one)",
                files_.front().string())});
        std::string left;
        for (const SeenColumn& column : columns_) {
            if (used_.count(&column) > 0 || times_.count(column.column) > 0 || left.size() > 400) continue;
            left += fmt::format("{}\"{}\"", left.empty() ? "" : ", ", column.column->name);
        }
        if (!left.empty()) guess("channels", Doubt::stated, "not used: " + left);
    }

    void find_tensions() {
        int number = 1;
        for (const SeenColumn& column : columns_) {
            if (times_.count(column.column) > 0 || used_.count(&column) > 0) continue;
            const std::string name = fmt::format("tension_{}", number);
            if (name_fits(column, name) < fits_by_name) continue;
            used_.insert(&column);
            add_channel(name, column);
            guess(name, Doubt::likely,
                  fmt::format("the name \"{}\" fits; state its place in [recording] tension_sensors",
                              column.column->name));
            ++number;
        }
    }

    // Without names: two angles that move together, and the torque with the larger loop beside the motor's
    // angle.
    void find_by_motion() {
        std::vector<const SeenColumn*> free;
        for (const SeenColumn& column : columns_) {
            if (times_.count(column.column) == 0 && used_.count(&column) == 0 && !column.rising &&
                !is_command(column))
                free.push_back(&column);
        }
        const ColumnsByMotion by_motion = columns_by_motion(free);
        const auto take = [&](const char* name, const SeenColumn* column, const std::string& reason) {
            if (column == nullptr || has(name)) return;
            used_.insert(column);
            add_channel(name, *column);
            guess(name, Doubt::doubtful, reason);
        };
        take(channel::motor_angle, by_motion.motor_angle,
             "it is smooth and moves with another column; motor and load may be exchanged");
        if (by_motion.load_angle)
            take(channel::load_angle, by_motion.load_angle,
                 fmt::format("it is smooth and moves with \"{}\" (correlation {:.2f})",
                             by_motion.motor_angle->column->name, by_motion.angles_alike));
        take(channel::motor_torque, by_motion.motor_torque, "it has the widest loop over the motor's angle");
        take(channel::load_torque, by_motion.load_torque, "it has the next wide loop over the motor's angle");
    }

    bool has(const std::string& name) const {
        return std::any_of(chosen_.begin(), chosen_.end(),
                           [&](const auto& entry) { return entry.first == name; });
    }

    const SeenColumn* chosen(const std::string& name) const {
        for (const auto& [channel, column] : chosen_) {
            if (channel == name) return column;
        }
        return nullptr;
    }

    // The other shaft's angle, if its unit is known.
    KnownAngle other_angle(const std::string& name) {
        const std::string other = name == channel::motor_angle ? channel::load_angle : channel::motor_angle;
        const SeenColumn* column = chosen(other);
        const ChannelMapping* mapping = mapped(other);
        const auto unit = mapping != nullptr ? find_unit(mapping->unit) : std::nullopt;
        if (column == nullptr || !unit || unit->quantity != Quantity::angle) return {};
        return {other, column->span * unit->si / find_unit("turn")->si};
    }

    ChannelMapping* mapped(const std::string& name) {
        for (ChannelMapping& channel : suggestion_.mapping.channels) {
            if (channel.name == name) return &channel;
        }
        return nullptr;
    }

    void add_channel(const std::string& name, const SeenColumn& column) {
        ChannelMapping channel;
        channel.name = name;
        channel.from.column = column.column->name;
        channel.from.table = column.table->name;
        if (logs_.size() > 1 && !same_columns()) channel.from.file = column.log->file.filename().string();
        chosen_.emplace_back(name, &column);
        guess_unit(channel, column, other_angle(name), suggestion_.guesses);
        suggestion_.mapping.channels.push_back(std::move(channel));
    }

    void find_kind() {
        const bool shafts = has(channel::motor_angle) && has(channel::load_angle);
        const bool tensions = std::any_of(chosen_.begin(), chosen_.end(), [](const auto& entry) {
            return entry.first.starts_with("tension_");
        });
        const BenchMode mode = options_.mode.value_or(shafts && !tensions ? BenchMode::lumped_drive
                                                      : shafts            ? BenchMode::pull_pull
                                                                          : BenchMode::single_cable);
        auto& recording = suggestion_.mapping.recording;
        recording["mode"] = mode_name(mode);
        if (!options_.mode && mode == BenchMode::lumped_drive)
            guess(
                "recording", Doubt::doubtful,
                "the kind of bench is guessed: a drive of which nothing but its two shafts is known, which tells least. If two cables "
                "run between a motor pulley and a load pulley, suggest again with --kind pull_pull and state their numbers");
        else if (!options_.mode)
            guess(
                "recording", Doubt::likely,
                fmt::format(
                    "the kind of bench is guessed from the channels; known are pull_pull, single_cable, lumped_drive "
                    "and capstan_band (--kind)"));
        if (mode != BenchMode::pull_pull && mode != BenchMode::single_cable) return;
        const auto sidecar = nlohmann::ordered_json::parse(recording_template(mode));
        recording["nominal"] = sidecar.at("nominal");
        if (tensions) {
            recording["tension_sensors"] = nlohmann::ordered_json::array();
            double place_m = 0.0;
            for (const auto& [name, column] : chosen_) {
                if (name.starts_with("tension_"))
                    recording["tension_sensors"].push_back(
                        {{"channel", name}, {"cable", "A"}, {"s", place_m += 0.1}});
            }
        }
        pretension_N_ = sidecar.at("runs").at(0).at("T0").get<double>();
        guess(
            "recording", Doubt::doubtful,
            "every number of the bench below, the places of tension sensors and each run's T0 are placeholders; replace them");
    }

    // What a trial import finds: clocks to be shifted, units and signs that contradict physics.
    void try_it() {
        if (pretension_N_ > 0.0) {
            if (suggestion_.mapping.runs.empty()) suggestion_.mapping.runs.emplace_back();
            for (RunMapping& run : suggestion_.mapping.runs) run.conditions["T0"] = pretension_N_;
        }
        ImportOptions options;
        options.on_progress = options_.on_progress;
        try {
            suggestion_.findings = try_import(files_, suggestion_.mapping, options).findings;
        } catch (const InvalidInput& error) {
            for (const std::string& problem : error.problems())
                guess("file", Doubt::doubtful, "a trial import fails: " + problem);
            return;
        }
        for (const Finding& finding : suggestion_.findings) {
            ChannelMapping* channel = mapped(finding.channel);
            if (finding.kind == FindingKind::clock_offset && channel != nullptr) {
                if (finding.repaired) channel->clock_offset_s = finding.amount;
                guess(finding.channel, finding.repaired ? Doubt::likely : Doubt::doubtful, finding.words);
            } else if (finding.kind == FindingKind::wrapped_counter && channel != nullptr) {
                channel->wraps_at = finding.amount;
                guess(finding.channel, Doubt::likely, finding.words);
            } else if (finding.kind == FindingKind::wrong_unit || finding.kind == FindingKind::wrong_sign ||
                       finding.kind == FindingKind::swapped_channels ||
                       finding.kind == FindingKind::constant_channel ||
                       finding.kind == FindingKind::saturated) {
                guess(finding.channel, Doubt::doubtful, finding.words);
            } else if (finding.kind == FindingKind::time_unit) {
                guess("time", Doubt::doubtful, finding.words);
            } else if (finding.kind != FindingKind::assumed) {
                guess("file", Doubt::stated, finding.words);
            }
        }
    }

    const std::vector<std::filesystem::path>& files_;
    const SuggestOptions& options_;
    std::vector<std::unique_ptr<logs::Log>> logs_;
    std::vector<SeenColumn> columns_;
    std::set<const logs::LogColumn*> times_;
    std::set<const SeenColumn*> used_;
    ChosenColumns chosen_;
    double pretension_N_ = 0.0;
    Suggestion suggestion_;
};

}  // namespace

Suggestion suggest_mapping(const std::vector<std::filesystem::path>& files, const SuggestOptions& options) {
    return Suggesting(files, options).suggested();
}

}  // namespace capstan::imports
