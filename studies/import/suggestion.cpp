#include "capstan/import/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/column_roles.h"
#include "capstan/import/guessed_units.h"
#include "capstan/import/importer.h"
#include "capstan/import/log_runs.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/rig/channel_names.h"

namespace capstan::imports {

namespace {

constexpr double fits_by_name = 0.5;
double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

// Of the parts that both have.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const std::size_t count = std::min(a.size(), b.size());
    if (count < 3) return 0.0;
    const double mean_a = mean(a);
    const double mean_b = mean(b);
    double ab = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        ab += (a[k] - mean_a) * (b[k] - mean_b);
        aa += (a[k] - mean_a) * (a[k] - mean_a);
        bb += (b[k] - mean_b) * (b[k] - mean_b);
    }
    return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

// Of a torque over an angle; positive where the torque drives against friction.
double loop_work(const std::vector<double>& torque, const std::vector<double>& angle) {
    const std::size_t count = std::min(torque.size(), angle.size());
    const double mean_torque = mean(torque);
    double sum = 0.0;
    for (std::size_t k = 1; k < count; ++k)
        sum += (0.5 * (torque[k] + torque[k - 1]) - mean_torque) * (angle[k] - angle[k - 1]);
    return sum;
}

// Smooth from reading to reading, or on an encoder's lattice: an angle. A load cell is noisy.
bool looks_like_angle(const SeenColumn& column) {
    double first = 0.0;
    double second = 0.0;
    for (std::size_t k = 2; k < column.readings.size(); ++k) {
        const double change = column.readings[k] - column.readings[k - 1];
        const double bend = column.readings[k] - 2.0 * column.readings[k - 1] + column.readings[k - 2];
        first += change * change;
        second += bend * bend;
    }
    return second < first;
}

/// Builds a suggestion step by step.
class Suggesting {
  public:
    Suggesting(const std::vector<std::filesystem::path>& files, const SuggestOptions& options)
        : files_(files), options_(options) {
        logs::ReadOptions reading;
        reading.text = options.text;
        reading.memory_limit_bytes = (64u << 20) / std::max<std::size_t>(files.size(), 1);
        for (std::size_t file = 0; file < files.size(); ++file) {
            if (options.on_progress)
                reading.on_progress = [this, file, &options](double part) {
                    options.on_progress(
                        "reading", (static_cast<double>(file) + part) / static_cast<double>(files_.size()));
                };
            logs_.push_back(std::make_unique<logs::Log>(logs::read_log(files[file], reading)));
        }
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
        find_times();
        find_channels();
        find_kind();
        find_signs();
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
        const auto names = [](const logs::Log& log) {
            std::vector<std::string> all;
            for (const auto& table : log.tables) {
                for (const auto& column : table.columns) all.push_back(table.name + "\n" + column.name);
            }
            return all;
        };
        return std::all_of(logs_.begin(), logs_.end(),
                           [&](const auto& log) { return names(*log) == names(*logs_.front()); });
    }

    // Times by name; else the column that rises with every row.
    void find_times() {
        TimeMapping& time = suggestion_.mapping.time;
        std::set<const logs::LogTable*> tables;
        for (const SeenColumn& column : columns_) tables.insert(column.table);
        for (const logs::LogTable* table : tables) {
            int found = time_column(*table, "");
            bool by_name = found >= 0;
            if (!by_name) {
                for (const SeenColumn& column : columns_) {
                    if (column.table != table || !column.rising || found >= 0) continue;
                    found = static_cast<int>(column.column - table->columns.data());
                }
            }
            if (found < 0) continue;
            const logs::LogColumn& column = table->columns[static_cast<std::size_t>(found)];
            times_.insert(&column);
            if (time.column.empty() && (!by_name || table->name.empty())) {
                time.column = column.name;
                if (!by_name)
                    guess("time", Doubt::likely,
                          fmt::format("\"{}\" is the column that rises with every row", column.name));
                settle_time_unit(column);
            }
        }
        if (times_.empty()) {
            time.sample_rate_Hz = 1000.0;
            guess("time", Doubt::doubtful,
                  "the log has no column of times; the rate is made up, state the logger's own");
        }
    }

    void settle_time_unit(const logs::LogColumn& column) {
        TimeMapping& time = suggestion_.mapping.time;
        const double stated = seconds_per_unit(column, "");
        std::vector<double> readings = logs::numbers_of(column.values, 4096);
        std::vector<double> periods;
        for (std::size_t k = 1; k < readings.size(); ++k) {
            if (readings[k] > readings[k - 1]) periods.push_back(readings[k] - readings[k - 1]);
        }
        if (periods.empty()) return;
        std::nth_element(periods.begin(), periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2),
                         periods.end());
        const double period = periods[periods.size() / 2];
        const auto usual = [&](double seconds) {
            const double rate_Hz = 1.0 / (period * seconds);
            return rate_Hz >= 15.0 && rate_Hz <= 20000.0;
        };
        const std::string name = find_unit(column.unit) ? column.unit : stated == 1.0 ? "s" : "";
        if (usual(stated)) {
            for (const char* unit : {"s", "ms", "us", "ns"}) {
                if (find_unit(unit)->si == stated) time.unit = unit;
            }
            return;
        }
        for (const char* unit : {"s", "ms", "us", "ns"}) {
            if (!usual(find_unit(unit)->si)) continue;
            time.unit = unit;
            guess("time", Doubt::likely,
                  fmt::format("in {} the rate is {:.4g} Hz; in {} it would be {:.4g} Hz, which no bench has",
                              unit, 1.0 / (period * find_unit(unit)->si),
                              column.unit.empty() ? "s" : "\"" + column.unit + "\", as the head says,",
                              1.0 / (period * stated)));
            return;
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
        std::vector<const SeenColumn*> angles;
        std::vector<const SeenColumn*> torques;
        for (const SeenColumn* column : free)
            (looks_like_angle(*column) ? angles : torques).push_back(column);
        const SeenColumn* motor = nullptr;
        const SeenColumn* load = nullptr;
        double best = 0.5;
        for (std::size_t a = 0; a < angles.size(); ++a) {
            for (std::size_t b = a + 1; b < angles.size(); ++b) {
                const double alike = std::abs(correlation(angles[a]->readings, angles[b]->readings));
                if (alike <= best) continue;
                best = alike;
                motor = angles[a];
                load = angles[b];
            }
        }
        if (motor == nullptr && !angles.empty()) motor = angles.front();
        if (motor == nullptr) return;
        // The motor's torque has the wider friction loop over its angle.
        const SeenColumn* motor_torque = nullptr;
        const SeenColumn* load_torque = nullptr;
        const auto loop = [&](const SeenColumn* torque) {
            return std::abs(loop_work(torque->readings, motor->readings)) / torque->span;
        };
        std::sort(torques.begin(), torques.end(), [&](auto* a, auto* b) { return loop(a) > loop(b); });
        if (!torques.empty()) motor_torque = torques[0];
        if (torques.size() > 1) load_torque = torques[1];
        const auto take = [&](const char* name, const SeenColumn* column, const std::string& reason) {
            if (column == nullptr || has(name)) return;
            used_.insert(column);
            add_channel(name, *column);
            guess(name, Doubt::doubtful, reason);
        };
        take(channel::motor_angle, motor,
             "it is smooth and moves with another column; motor and load may be exchanged");
        take(channel::load_angle, load,
             fmt::format("it is smooth and moves with \"{}\" (correlation {:.2f})", motor->column->name,
                         best));
        take(channel::motor_torque, motor_torque, "it has the widest loop over the motor's angle");
        take(channel::load_torque, load_torque, "it has the next wide loop over the motor's angle");
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
        if (!options_.mode)
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

    // Motor and load turn the same way when cable A pulls, and friction takes work from the motor.
    void find_signs() {
        const SeenColumn* motor = chosen(channel::motor_angle);
        const SeenColumn* load = chosen(channel::load_angle);
        const SeenColumn* torque = chosen(channel::motor_torque);
        const SeenColumn* load_torque = chosen(channel::load_torque);
        if (motor != nullptr && load != nullptr && motor->table == load->table) {
            const double alike = correlation(motor->readings, load->readings);
            if (alike < -0.3) {
                mapped(channel::load_angle)->sign = -1.0;
                guess(
                    channel::load_angle, Doubt::likely,
                    fmt::format(
                        "sign = -1: it falls as the motor's angle rises (correlation {:.2f}), and cable A turns both the "
                        "same way",
                        alike));
            } else if (std::abs(alike) < 0.3) {
                guess(channel::load_angle, Doubt::doubtful,
                      "it does not move with the motor's angle; its sign cannot be seen");
            }
        }
        if (torque == nullptr || motor == nullptr || torque->table != motor->table) return;
        const bool both = load != nullptr && load_torque != nullptr && load->table == motor->table &&
                          load_torque->table == motor->table;
        if (both) {
            signs_by_both_ends(*motor, *load, *torque, *load_torque);
        } else {
            sign_by_motor(*motor, *torque);
        }
    }

    double work_J(const std::string& torque_name, const SeenColumn& torque, const std::string& angle_name,
                  const SeenColumn& angle) {
        return loop_work(torque.readings, angle.readings) * mapped(torque_name)->factor() *
               mapped(angle_name)->factor();
    }

    // The torques have one direction, in which friction takes work from both ends together.
    void signs_by_both_ends(const SeenColumn& motor, const SeenColumn& load, const SeenColumn& torque,
                            const SeenColumn& load_torque) {
        const double alike = correlation(torque.readings, load_torque.readings);
        const double together =
            std::abs(alike) > 0.3 ? alike : mean(torque.readings) * mean(load_torque.readings);
        const double load_sign = together < 0.0 ? -1.0 : 1.0;
        const double motor_J = work_J(channel::motor_torque, torque, channel::motor_angle, motor);
        const double load_J =
            load_sign * work_J(channel::load_torque, load_torque, channel::load_angle, load);
        const double lost_J = motor_J - load_J;
        const double turned = lost_J < 0.0 ? -1.0 : 1.0;
        mapped(channel::motor_torque)->sign = turned;
        mapped(channel::load_torque)->sign = turned * load_sign;
        const bool clear = std::abs(lost_J) > 0.05 * (std::abs(motor_J) + std::abs(load_J));
        if (turned < 0.0)
            guess(channel::motor_torque, clear ? Doubt::likely : Doubt::doubtful,
                  fmt::format("sign = -1: else motor and load together would take {:.3g} J out of friction",
                              -lost_J));
        else if (!clear)
            guess(channel::motor_torque, Doubt::doubtful,
                  "the work lost to friction is too small to show its sign");
        if (turned * load_sign < 0.0 || std::abs(alike) < 0.3)
            guess(channel::load_torque, std::abs(alike) < 0.3 ? Doubt::doubtful : Doubt::likely,
                  std::abs(alike) < 0.3
                      ? "its correlation with the motor's torque is below 0.3, so its sign is a guess"
                      : "sign = -1: it is positive where it acts as the motor's torque does");
    }

    // Right where the motor drives; a hand that turns it would show the other sign.
    void sign_by_motor(const SeenColumn& motor, const SeenColumn& torque) {
        const double work = loop_work(torque.readings, motor.readings);
        const double size = torque.span * motor.span;
        const double angle_sign = mapped(channel::motor_angle)->sign;
        if (work * angle_sign < -0.05 * size) {
            mapped(channel::motor_torque)->sign = -1.0;
            guess(
                channel::motor_torque, Doubt::doubtful,
                "sign = -1: else the motor would take work from the transmission over closed loops, as it does only where "
                "a hand turns the load");
        } else if (work * angle_sign < 0.05 * size) {
            guess(channel::motor_torque, Doubt::doubtful,
                  "its loop over the motor's angle is too narrow to show its sign");
        }
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
    std::vector<std::pair<std::string, const SeenColumn*>> chosen_;
    double pretension_N_ = 0.0;
    Suggestion suggestion_;
};

const char* doubt_words(Doubt doubt) {
    switch (doubt) {
        case Doubt::stated:
            return "Note";
        case Doubt::likely:
            return "Likely";
        case Doubt::doubtful:
            break;
    }
    return "DOUBTFUL";
}

}  // namespace

std::string Suggestion::text() const {
    std::vector<std::pair<std::string, std::string>> reasons = {
        {"file",
         "A suggestion by `capstan import --suggest`. Every guess has its reason; correct what is wrong, then run"},
        {"file", "  capstan import LOG... --mapping THIS_FILE -o NAME"}};
    for (const Guess& guess : guesses) {
        std::string reason = guess.reason;
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        reasons.emplace_back(guess.about, fmt::format("{}: {}", doubt_words(guess.doubt), reason));
    }
    return mapping_text(mapping, reasons);
}

Suggestion suggest_mapping(const std::vector<std::filesystem::path>& files, const SuggestOptions& options) {
    return Suggesting(files, options).suggested();
}

}  // namespace capstan::imports
