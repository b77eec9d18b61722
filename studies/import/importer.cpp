#include "capstan/import/importer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/clock_offset.h"
#include "capstan/import/plausibility.h"
#include "capstan/import/stretch_plan.h"
#include "capstan/platform/files.h"
#include "capstan/recording/json_object.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/rig/channel_names.h"

namespace capstan::imports {

namespace {

using nlohmann::ordered_json;

// A channel that lags more than this is another experiment's.
constexpr double longest_offset_s = 1.0;
// Within one logger only a filter or a slow bus delays a channel.
constexpr double longest_delay_s = 0.1;
// An offset is named when it is more than this many samples and its own uncertainty.
constexpr double named_offset_periods = 0.75;
// Without it the others leave at least so many times more of the channel's variance; more within one logger,
// where an offset is not to be expected.
constexpr double named_offset_gain = 1.5;
constexpr double named_delay_gain = 2.5;
constexpr double named_offset_deviations = 3.0;  // it is larger than so many times its uncertainty
// How wrong the model of friction may be, as a part of a channel's variance. Angles follow one another
// exactly but for stretch.
constexpr double angle_model_error = 1e-6;
constexpr double torque_model_error = 2e-3;
constexpr double nominal_model_error = 2e-4;
constexpr double longest_usual_period_s = 0.1;
constexpr double shortest_usual_period_s = 5e-5;

/// All that is known of an import before its samples are written.
class Import {
  public:
    Import(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
           const ImportOptions& options)
        : mapping_(mapping), options_(options), problems_() {
        for (const auto& file : files) report_.files.push_back(file.filename().string());
        logs_ = read_log_runs(
            files, mapping, [&](double part) { tell("reading", part); }, problems_);
        report_.findings = logs_.findings;
        survey_runs();
        leave_out_constant_channels();
        for (const StretchPlan& plan : plans_) {
            if (!plan.pieces.empty()) report_.sample_rate_Hz = plan.sample_rate_Hz;
        }
        number_runs();
        align_clocks();
        preview();
    }

    ImportReport take_report() { return std::move(report_); }

    void write(const std::filesystem::path& name) {
        std::filesystem::path samples = name;
        std::filesystem::path sidecar = name;
        if (name.extension() != ".csv" && name.extension() != ".json") {
            samples += ".csv";
            sidecar += ".json";
        } else {
            samples.replace_extension(".csv");
            sidecar.replace_extension(".json");
        }
        if (std::find(report_.files.begin(), report_.files.end(), samples.filename().string()) !=
                report_.files.end() &&
            std::filesystem::exists(samples))
            throw InvalidInput({fmt::format("{}: is one of the logs; give the recording another name with -o",
                                            samples.string())});
        refuse_what_no_reader_takes();
        AtomicFile file(samples);
        file.append("run,t," + fmt::format("{}", fmt::join(report_.channels, ",")) + "\n");
        double written_s = 0.0;
        double all_s = 0.0;
        for (const Piece& piece : pieces_) all_s += piece.to_s - piece.from_s;
        std::string text;
        for (std::size_t index = 0; index < pieces_.size(); ++index) {
            const Piece& piece = pieces_[index];
            for_each_row(logs_.runs[piece.log_run], piece, kept_,
                         [&](double time_s, std::span<const double> values) {
                             append_row(text, report_.runs[index].number, time_s, values);
                             if (text.size() < 1u << 18) return;
                             file.append(text);
                             text.clear();
                             tell("writing", all_s > 0.0 ? (written_s + time_s) / all_s : 1.0);
                         });
            written_s += piece.to_s - piece.from_s;
        }
        file.append(text);
        const std::string description = sidecar_json().dump(2) + "\n";
        file.finish();
        write_file(sidecar, description);
    }

  private:
    // With what was found, which may say why.
    void refuse_what_no_reader_takes() {
        check_recording(report_.recording, "the recording", problems_);
        if (problems_.empty()) return;
        std::vector<std::string> words = problems_.listed(SIZE_MAX);
        for (const Finding& finding : report_.findings) {
            if (!finding.repaired && finding.kind != FindingKind::assumed) words.push_back(finding.words);
        }
        throw InvalidInput(words);
    }

    static void append_row(std::string& text, int run, double time_s, std::span<const double> values) {
        auto out = std::back_inserter(text);
        fmt::format_to(out, "{},{:.10g}", run, time_s);
        for (const double value : values) fmt::format_to(out, ",{:.9g}", value);
        text += '\n';
    }

    void tell(const char* activity, double fraction) const {
        if (options_.on_progress) options_.on_progress(activity, fraction);
    }

    void survey_runs() {
        for (std::size_t index = 0; index < logs_.runs.size(); ++index) {
            plans_.push_back(plan_stretch(logs_.runs[index], index, mapping_, report_.findings));
            tell("checking", static_cast<double>(index + 1) / static_cast<double>(logs_.runs.size()));
        }
        for (const StretchPlan& plan : plans_)
            pieces_.insert(pieces_.end(), plan.pieces.begin(), plan.pieces.end());
        if (pieces_.empty()) {
            std::vector<std::string> words = {
                "no run is left: the log has no stretch of 20 samples in which every channel "
                "has readings"};
            for (const Finding& finding : report_.findings) words.push_back(finding.words);
            throw InvalidInput(words);
        }
        check_time_unit();
    }

    void check_time_unit() {
        double period_s = 0.0;
        for (const StretchPlan& plan : plans_) {
            if (!plan.surveys.empty()) period_s = plan.surveys.front().period_s;
        }
        if (period_s <= longest_usual_period_s && period_s >= shortest_usual_period_s) return;
        const bool slow = period_s > longest_usual_period_s;
        report_.findings.push_back(
            {.kind = FindingKind::time_unit,
             .amount = period_s,
             .words =
                 fmt::format("the log's rate is {:.4g} Hz by its times, {} for a bench; are the times in {} "
                             "rather than in {}? State time.unit",
                             1.0 / period_s, slow ? "very slow" : "very fast", slow ? "ms" : "s",
                             mapping_.time.unit.empty() ? "the unit that was assumed" : mapping_.time.unit)});
    }

    void leave_out_constant_channels() {
        for (std::size_t channel = 0; channel < mapping_.channels.size(); ++channel) {
            const bool constant = std::all_of(plans_.begin(), plans_.end(), [&](const StretchPlan& plan) {
                return plan.surveys.empty() || plan.surveys[channel].constant();
            });
            const std::string& name = mapping_.channels[channel].name;
            if (constant && name != channel::load_angle) {  // a lock may hold perfectly
                report_.findings.push_back(
                    {.kind = FindingKind::constant_channel,
                     .repaired = true,
                     .channel = name,
                     .words = fmt::format(
                         "{} never changes; a sensor that is not connected? The channel is left out", name)});
            } else {
                kept_.push_back(channel);
                report_.channels.push_back(name);
            }
        }
        if (kept_.empty()) throw InvalidInput({"every channel is constant: nothing moves in this log"});
    }

    // Samples of a run at one rate, for looking at it: its longest piece.
    std::vector<std::vector<double>> preview_of(std::size_t run, std::size_t limit, double& rate_Hz) const {
        const auto& pieces = plans_[run].pieces;
        const auto longest = std::max_element(
            pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return a.to_s - a.from_s < b.to_s - b.from_s; });
        std::vector<std::vector<double>> values(kept_.size());
        if (longest == pieces.end()) return values;
        Piece piece = *longest;
        rate_Hz =
            plans_[run].surveys.front().period_s > 0.0 ? 1.0 / plans_[run].surveys.front().period_s : 1.0;
        piece.grid_Hz = rate_Hz;
        piece.thinned_by = 1;
        piece.to_s = std::min(piece.to_s, piece.from_s + static_cast<double>(limit) / rate_Hz);
        for_each_row(logs_.runs[run], piece, kept_, [&](double, std::span<const double> row) {
            for (std::size_t k = 0; k < row.size(); ++k) values[k].push_back(row[k]);
        });
        return values;
    }

    bool same_clock(const LogRun& run, std::size_t a, std::size_t b) const {
        const Clock& one = run.sources[kept_[a]].clock;
        const Clock& other = run.sources[kept_[b]].clock;
        return one.table == other.table && one.column == other.column;
    }

    bool is_angle(std::size_t k) const { return report_.channels[k].ends_with("_angle"); }

    // The clock of the first angle counts, or of the first channel. Then clock after clock is aligned to
    // those that are: an angle that follows another angle knows its offset best, and speaks for its clock; a
    // torque lags behind angles for other reasons too, so it comes last. Offsets that the mapping states are
    // kept. An angle that is late within the first clock is named and left.
    void align_clocks() {
        std::vector<std::size_t> order(kept_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return is_angle(a) > is_angle(b); });
        const LogRun& run = logs_.runs[pieces_.front().log_run];
        std::vector<std::size_t> aligned;
        for (const std::size_t k : order) {
            const bool known = aligned.empty() || mapping_.channels[kept_[k]].clock_offset_s.has_value() ||
                               std::any_of(aligned.begin(), aligned.end(),
                                           [&](std::size_t other) { return same_clock(run, k, other); });
            const bool late_angle =
                known && !aligned.empty() && is_angle(k) && same_clock(run, k, aligned.front());
            if (!known || late_angle) {
                auto offset = channel_offset(k, aligned, !known);
                if (!known && !is_angle(k)) {
                    const auto modelled = offset_by_model(k, aligned);
                    if (modelled &&
                        (!offset || modelled->offset.uncertainty_s < offset->offset.uncertainty_s))
                        offset = modelled;
                }
                if (offset) settle_offset(*offset, run);
            }
            aligned.push_back(k);
        }
    }

    // What the runs say of a channel's offset together.
    struct ChannelOffset {
        std::size_t channel = 0;  ///< kept
        ClockOffset offset;
        double period_s = 0.0;
        bool other_clock = false;
    };

    std::optional<ChannelOffset> channel_offset(std::size_t k, const std::vector<std::size_t>& aligned,
                                                bool other_clock) const {
        std::vector<ClockOffset> found;
        double rate_Hz = 1.0;
        for (std::size_t run = 0; run < logs_.runs.size() && found.size() < most_runs_looked_at; ++run) {
            if (plans_[run].pieces.empty()) continue;
            const auto values = preview_of(run, 3 * preview_samples, rate_Hz);
            std::vector<ClockReference> others;
            for (const std::size_t other : aligned) {
                // An angle follows an angle, without friction's lag.
                if (!is_angle(k) || is_angle(other))
                    others.push_back({values[other], is_angle(other) && !is_angle(k)});
            }
            const auto offset = find_clock_offset(values[k], others, rate_Hz,
                                                  other_clock ? longest_offset_s : longest_delay_s,
                                                  is_angle(k) ? angle_model_error : torque_model_error);
            if (offset) found.push_back(*offset);
        }
        if (found.empty()) return std::nullopt;
        return together(k, found, 1.0 / rate_Hz, other_clock);
    }

    // A channel of a clock of its own beside what the nominal model says of it from the aligned inputs.
    std::optional<ChannelOffset> offset_by_model(std::size_t k, const std::vector<std::size_t>& aligned) {
        const Recording recording = preview_recording();
        if (!recording.nominal) return std::nullopt;
        std::vector<ClockOffset> found;
        double period_s = 1.0;
        for (std::size_t run = 0; run < recording.runs.size() && found.size() < most_runs_looked_at; ++run) {
            const RecordedRun& recorded = recording.runs[run];
            const bool inputs_aligned =
                std::all_of(recorded.driven.begin(), recorded.driven.end(), [&](const auto& name) {
                    const auto channel = recording.channel(name);
                    return channel && std::find(aligned.begin(), aligned.end(),
                                                static_cast<std::size_t>(*channel)) != aligned.end();
                });
            if (!inputs_aligned || recorded.samples() < 2) continue;
            const std::vector<double> modelled = modelled_channel(recording, run, k);
            if (modelled.empty()) continue;
            period_s = (recorded.time_s.back() - recorded.time_s.front()) / (recorded.samples() - 1);
            if (const auto offset = find_clock_offset(recorded.values[k], {{modelled, false, false}},
                                                      1.0 / period_s, longest_offset_s, nominal_model_error))
                found.push_back(*offset);
        }
        if (found.empty()) return std::nullopt;
        return together(k, found, period_s, true);
    }

    static ChannelOffset together(std::size_t k, const std::vector<ClockOffset>& found, double period_s,
                                  bool other_clock) {
        ChannelOffset all{k, found.front(), period_s, other_clock};
        double low = found.front().offset_s;
        double high = low;
        double sum = 0.0;
        for (const ClockOffset& offset : found) {
            sum += offset.offset_s;
            low = std::min(low, offset.offset_s);
            high = std::max(high, offset.offset_s);
            all.offset.uncertainty_s = std::max(all.offset.uncertainty_s, offset.uncertainty_s);
            all.offset.unexplained = std::max(all.offset.unexplained, offset.unexplained);
            all.offset.unexplained_at_zero =
                std::min(all.offset.unexplained_at_zero, offset.unexplained_at_zero);
        }
        all.offset.offset_s = sum / static_cast<double>(found.size());
        all.offset.uncertainty_s = std::max(all.offset.uncertainty_s, 0.5 * (high - low));
        return all;
    }

    // All channels of the clock are shifted, or it is said that they are late.
    void settle_offset(const ChannelOffset& found, const LogRun& run) {
        const ClockOffset& offset = found.offset;
        const double gain = found.other_clock ? named_offset_gain : named_delay_gain;
        if (offset.unexplained_at_zero <= gain * offset.unexplained) return;
        if (std::abs(offset.offset_s) <
            std::max(named_offset_periods * found.period_s, named_offset_deviations * offset.uncertainty_s))
            return;
        for (std::size_t k = 0; k < kept_.size(); ++k) {
            if (k == found.channel || (found.other_clock && same_clock(run, k, found.channel) &&
                                       !mapping_.channels[kept_[k]].clock_offset_s))
                note_shift(found, k);
        }
    }

    void note_shift(const ChannelOffset& by, std::size_t k) {
        const std::string& name = report_.channels[k];
        const double rounded_s = std::round(by.offset.offset_s * 1e5) / 1e5;
        const std::string from =
            k == by.channel
                ? fmt::format(
                      "+-{:.2g} ms; without it {:.1f}% of its variance is unexplained, with it {:.1f}%",
                      1e3 * by.offset.uncertainty_s, 100.0 * by.offset.unexplained_at_zero,
                      100.0 * by.offset.unexplained)
                : fmt::format("as that of {}, which shares it", report_.channels[by.channel]);
        report_.findings.push_back(
            {.kind = FindingKind::clock_offset,
             .repaired = by.other_clock,
             .channel = name,
             .amount = rounded_s,
             .uncertainty = by.offset.uncertainty_s,
             .words = fmt::format(
                 "the clock of {} is {:.4g} ms {} that of the other channels ({}); {}", name,
                 std::abs(1e3 * rounded_s), rounded_s > 0 ? "behind" : "ahead of", from,
                 by.other_clock ? "it is shifted"
                                : fmt::format("state clock_offset_s = {:.5f} to shift it", rounded_s))});
        if (!by.other_clock) return;
        for (LogRun& run : logs_.runs) run.sources[kept_[k]].clock_offset_s = rounded_s;
        shifted_ = true;
    }

    // The runs of the recording, and a few of their samples for checks and figures.
    void preview() {
        if (shifted_) replan();
        report_.recording = preview_recording();
        for (Finding& doubt : doubts_of(report_.recording)) report_.findings.push_back(std::move(doubt));
        for (const std::string& assumption : report_.recording.assumptions)
            report_.findings.push_back({.kind = FindingKind::assumed, .words = assumption});
        refuse_repairs();
    }

    // With shifted clocks the common stretch is another one.
    void replan() {
        std::vector<Finding> again;
        plans_.clear();
        pieces_.clear();
        for (std::size_t index = 0; index < logs_.runs.size(); ++index) {
            plans_.push_back(plan_stretch(logs_.runs[index], index, mapping_, again));
            const auto& pieces = plans_.back().pieces;
            pieces_.insert(pieces_.end(), pieces.begin(), pieces.end());
        }
        number_runs();
    }

    void number_runs() {
        report_.runs.clear();
        starts_s_.clear();
        std::set<int> used;
        double session_start_s = 0.0;
        bool first = true;
        for (const Piece& piece : pieces_) {
            const LogRun& run = logs_.runs[piece.log_run];
            int number = run.run_column != nullptr ? static_cast<int>(run.run_value) : 0;
            if (number <= 0 || used.count(number) > 0) number = used.empty() ? 1 : *used.rbegin() + 1;
            used.insert(number);
            if (first) session_start_s = piece.from_s;
            first = false;
            ImportedRun imported{number, source_words(run, piece), 0, piece.to_s - piece.from_s};
            report_.runs.push_back(imported);
            starts_s_.push_back(piece.from_s - session_start_s);
        }
    }

    std::string source_words(const LogRun& run, const Piece& piece) const {
        std::string words;
        for (const auto& file : run.files) words += (words.empty() ? "" : ", ") + file.filename().string();
        const StretchPlan& plan = plans_[piece.log_run];
        if (plan.pieces.size() > 1)
            words += fmt::format(", {:.4g} s to {:.4g} s", piece.from_s - plan.pieces.front().from_s,
                                 piece.to_s - plan.pieces.front().from_s);
        return words;
    }

    Recording preview_recording() {
        SampleTable samples{report_.channels, {}, 1.0 / report_.sample_rate_Hz};
        samples.columns.insert(samples.columns.begin(), {"run", "t"});
        for (const ImportedRun& run : report_.runs) samples.run_numbers.push_back(run.number);
        const std::string place = mapping_.file.empty() ? "mapping" : mapping_.file + " [recording]";
        Recording recording = read_sidecar(nlohmann::json(sidecar_json()), place, samples, problems_);
        problems_.throw_if_any();
        // The reader orders channels by the sidecar; here they follow the table.
        std::sort(recording.channels.begin(), recording.channels.end(),
                  [&](const Channel& a, const Channel& b) {
                      const auto place_of = [&](const Channel& channel) {
                          return std::find(report_.channels.begin(), report_.channels.end(), channel.name);
                      };
                      return place_of(a) < place_of(b);
                  });
        for (std::size_t index = 0; index < pieces_.size(); ++index) {
            RecordedRun& run = recording.runs[index];
            run.values.assign(kept_.size(), {});
            const Piece& piece = pieces_[index];
            const double expected = (piece.to_s - piece.from_s) * report_.sample_rate_Hz + 1.0;
            const auto every =
                static_cast<std::size_t>(std::ceil(expected / static_cast<double>(preview_samples)));
            std::size_t row = 0;
            report_.runs[index].samples = for_each_row(logs_.runs[piece.log_run], piece, kept_,
                                                       [&](double time_s, std::span<const double> values) {
                                                           if (row++ % std::max<std::size_t>(every, 1) != 0)
                                                               return;
                                                           run.time_s.push_back(time_s);
                                                           for (std::size_t k = 0; k < values.size(); ++k)
                                                               run.values[k].push_back(values[k]);
                                                       });
        }
        return recording;
    }

    void refuse_repairs() const {
        if (!options_.strict) return;
        std::vector<std::string> refused;
        for (const Finding& finding : report_.findings) {
            if (finding.repaired || finding.kind == FindingKind::unread) refused.push_back(finding.words);
        }
        if (refused.empty()) return;
        refused.insert(refused.begin(),
                       "--strict repairs nothing, and this log needs it; mend the log or the mapping, or "
                       "import without --strict:");
        throw InvalidInput(refused);
    }

    const RunMapping* conditions_of(const LogRun& run) const {
        if (run.mapping != nullptr || run.run_column == nullptr) return run.mapping;
        for (const RunMapping& mapped : mapping_.runs) {
            const auto number = mapped.conditions.find("run");
            if (number != mapped.conditions.end() && number->is_number() &&
                number->get<double>() == run.run_value)
                return &mapped;
        }
        return nullptr;
    }

    ordered_json sidecar_json() const {
        ordered_json sidecar = {{"case", mapping_.recording.value("case", report_.files.front())},
                                {"schema", 1}};
        if (mapping_.recording.is_object()) {
            for (const auto& [key, value] : mapping_.recording.items()) sidecar[key] = value;
        }
        sidecar["sample_rate_hz"] = report_.sample_rate_Hz;
        if (sidecar.contains("tension_sensors") && sidecar["tension_sensors"].is_array()) {
            ordered_json sensors = ordered_json::array();  // without those of channels that are left out
            for (const auto& sensor : sidecar["tension_sensors"]) {
                const std::string channel = sensor.is_object() ? sensor.value("channel", "") : "";
                const bool mapped = std::any_of(mapping_.channels.begin(), mapping_.channels.end(),
                                                [&](const auto& each) { return each.name == channel; });
                const bool kept = std::find(report_.channels.begin(), report_.channels.end(), channel) !=
                                  report_.channels.end();
                if (kept || !mapped) sensors.push_back(sensor);
            }
            sidecar["tension_sensors"] = sensors;
        }
        ordered_json units = {{"t", "s"}};
        for (std::size_t k = 0; k < kept_.size(); ++k) {
            const ChannelMapping& channel = mapping_.channels[kept_[k]];
            std::string unit(channel_unit(channel.name));
            if (unit.empty()) {
                const auto known = find_unit(channel.unit);
                unit = known ? std::string(si_unit(known->quantity)) : channel.unit;
            }
            units[channel.name] = unit;
            if (channel.noise_std) sidecar["noise_std"][channel.name] = *channel.noise_std;
            if (const double step = step_of(k); step > 0.0) sidecar["encoder_step"][channel.name] = step;
        }
        sidecar["units"] = units;
        sidecar["runs"] = ordered_json::array();
        for (std::size_t index = 0; index < pieces_.size(); ++index) {
            const LogRun& run = logs_.runs[pieces_[index].log_run];
            ordered_json entry = {{"run", report_.runs[index].number},
                                  {"source", report_.runs[index].source}};
            if (const RunMapping* mapped = conditions_of(run)) {
                for (const auto& [key, value] : mapped->conditions.items()) entry[key] = value;
                entry["run"] = report_.runs[index].number;
            }
            if (!entry.contains("t_session_start") && starts_s_[index] > 0.0)
                entry["t_session_start"] = std::round(starts_s_[index] * 1e6) / 1e6;
            sidecar["runs"].push_back(entry);
        }
        ordered_json repairs = ordered_json::array();
        for (const Finding& finding : report_.findings) {
            if (finding.kind != FindingKind::assumed)
                repairs.push_back({{"what", finding_name(finding.kind)},
                                   {"repaired", finding.repaired},
                                   {"words", finding.words}});
        }
        sidecar["import"] = {{"files", report_.files},
                             {"mapping", std::filesystem::path(mapping_.file).filename().string()},
                             {"findings", repairs}};
        return sidecar;
    }

    // Of the converter: stated, or one count.
    double step_of(std::size_t k) const {
        const ChannelMapping& channel = mapping_.channels[kept_[k]];
        if (channel.step) return *channel.step;
        const auto unit = find_unit(channel.unit);
        const bool counts = unit ? unit->quantity == Quantity::counts : channel.scale.has_value();
        if (counts && (channel.scale || channel.counts_per_turn)) return std::abs(channel.factor());
        double step = 0.0;  // a lattice that all runs share
        if (!channel.name.ends_with("_angle")) return 0.0;
        for (const StretchPlan& plan : plans_) {
            if (plan.surveys.empty()) continue;
            const double own = plan.surveys[kept_[k]].step;
            if (own == 0.0 || (step != 0.0 && std::abs(own - step) > 0.02 * step)) return 0.0;
            step = own;
        }
        return std::round(step * 1e9) / 1e9;
    }

    static constexpr std::size_t most_runs_looked_at = 6;

    const Mapping& mapping_;
    const ImportOptions& options_;
    ProblemList problems_;
    LogRuns logs_;
    std::vector<StretchPlan> plans_;  // by run of the log
    std::vector<Piece> pieces_;       // runs of the recording
    std::vector<double> starts_s_;    // of the pieces, from the first one's
    std::vector<std::size_t> kept_;   // channels of the mapping that are not constant
    bool shifted_ = false;
    ImportReport report_;
};

}  // namespace

ImportReport import_logs(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                         const std::filesystem::path& name, const ImportOptions& options) {
    Import import(files, mapping, options);
    import.write(name);
    return import.take_report();
}

ImportReport try_import(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                        const ImportOptions& options) {
    return Import(files, mapping, options).take_report();
}

}  // namespace capstan::imports
