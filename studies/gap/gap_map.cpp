#include "capstan/gap/gap_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "capstan/recording/block_bootstrap.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// A part is named if it holds at least this fraction of the gap, and this many times its fraction of samples.
constexpr double worth_naming_density = 1.3;
constexpr double worth_naming_fraction = 0.4;

struct Part {
    std::string by;
    std::string name;
};

// The explainable energy and the samples that a block of time adds to each part.
struct Block {
    std::size_t run = 0;
    std::vector<double> energy;   // parts
    std::vector<double> samples;  // parts
};

class Tally {
  public:
    Tally(const Recording& recording, const std::vector<RunResiduals>& runs)
        : recording_(recording), sortings_(sample_sortings(recording, runs)) {
        for (const RecordedRun& run : recording.runs) parts_.push_back({"run", std::to_string(run.number)});
        for (const Channel& channel : recording.channels) parts_.push_back({"channel", channel.name});
        for (const TensionSensor& sensor : recording.tension_sensors)
            parts_.push_back({"place", place_part(sensor)});
        for (const SampleSorting& sorting : sortings_) {
            for (const std::string& part : sorting.parts) parts_.push_back({sorting.by, part});
        }
        for (const RunResiduals& run : runs) count(run);
    }

    const std::vector<Part>& parts() const { return parts_; }
    const std::vector<Block>& blocks() const { return blocks_; }

  private:
    void count(const RunResiduals& run) {
        const int samples = recording_.runs[run.run].samples();
        const int block = bootstrap_block_samples(recording_);
        for (int first = run.first_sample; first < samples; first += block) {
            blocks_.push_back(
                {run.run, std::vector<double>(parts_.size(), 0.0), std::vector<double>(parts_.size(), 0.0)});
            for (int sample = first; sample < std::min(samples, first + block); ++sample)
                count(run, static_cast<std::size_t>(sample), blocks_.back());
        }
    }

    void count(const RunResiduals& run, std::size_t sample, Block& block) {
        for (std::size_t channel = 0; channel < run.residual.size(); ++channel) {
            if (run.residual[channel].empty()) continue;
            const double residual = run.residual[channel][sample];
            const auto add = [&](std::size_t part) {
                block.energy[part] += residual * residual - 1.0;
                block.samples[part] += 1.0;
            };
            std::size_t next = 0;
            add(run.run);
            next += recording_.runs.size();
            add(next + channel);
            next += recording_.channels.size();
            for (const TensionSensor& sensor : recording_.tension_sensors) {
                if (recording_.channels[channel].name == sensor.channel) add(next);
                ++next;
            }
            for (const SampleSorting& sorting : sortings_) {
                const int part = sorting.part_of[run.run][sample];
                if (part >= 0) add(next + static_cast<std::size_t>(part));
                next += sorting.parts.size();
            }
        }
    }

    const Recording& recording_;
    std::vector<SampleSorting> sortings_;
    std::vector<Part> parts_;
    std::vector<Block> blocks_;
};

// The fraction of each part among all parts of its kind; 0 where the kind has no energy.
std::vector<double> fractions_of(const std::vector<Part>& parts, const std::vector<double>& sums) {
    std::vector<double> fractions(parts.size(), 0.0);
    for (std::size_t part = 0; part < parts.size(); ++part) {
        double all = 0.0;
        for (std::size_t other = 0; other < parts.size(); ++other) {
            if (parts[other].by == parts[part].by) all += std::max(0.0, sums[other]);
        }
        if (all > 0.0) fractions[part] = std::max(0.0, sums[part]) / all;
    }
    return fractions;
}

}  // namespace

std::string place_part(const TensionSensor& sensor) {
    return fmt::format("{:.2f} m on cable {}", sensor.position_m, sensor.cable == CableName::a ? "A" : "B");
}

std::vector<GapFraction> gap_map(const Recording& recording, const std::vector<RunResiduals>& runs) {
    const Tally tally(recording, runs);
    const std::vector<Part>& parts = tally.parts();
    std::vector<double> energy(parts.size(), 0.0);
    std::vector<double> samples(parts.size(), 0.0);
    double sum = 0.0;
    for (const Block& block : tally.blocks()) {
        for (std::size_t part = 0; part < parts.size(); ++part) {
            energy[part] += block.energy[part];
            samples[part] += block.samples[part];
            if (parts[part].by == "run") sum += block.energy[part];
        }
    }
    if (!(sum > 0.0)) return {};

    std::vector<std::vector<double>> drawn_fractions(parts.size());
    for_each_bootstrap_draw(tally.blocks().size(), 20221, [&](std::span<const std::size_t> drawn) {
        std::vector<double> sums(parts.size(), 0.0);
        for (const std::size_t block : drawn) {
            for (std::size_t part = 0; part < parts.size(); ++part)
                sums[part] += tally.blocks()[block].energy[part];
        }
        const std::vector<double> fractions = fractions_of(parts, sums);
        for (std::size_t part = 0; part < parts.size(); ++part)
            drawn_fractions[part].push_back(fractions[part]);
    });

    const std::vector<double> fractions = fractions_of(parts, energy);
    const std::vector<double> of_samples = fractions_of(parts, samples);
    std::vector<GapFraction> map;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        if (samples[part] == 0.0) continue;
        const BootstrapInterval interval = middle_95(std::move(drawn_fractions[part]));
        map.push_back({parts[part].by, parts[part].name, fractions[part], interval.low, interval.high,
                       of_samples[part]});
    }
    return map;
}

std::string gap_sentence(const std::vector<GapFraction>& map) {
    if (map.empty()) return "No residual remains beyond the noise and the model's own error.";
    // Each kind of part, and how a sentence names one.
    static constexpr std::pair<const char*, const char*> kinds[] = {
        {"channel", ""},
        {"run", "run "},
        {"regime", "regime "},
        {"direction", ""},
        {"speed", "speed "},
        {"tension", "tension "},
        {"since reversal", "time since reversal "},
        {"session", "session time "},
        {"place", ""}};
    std::string sentence;
    for (const auto& [by, prefix] : kinds) {
        const GapFraction* densest = nullptr;
        int parts = 0;
        for (const GapFraction& fraction : map) {
            if (fraction.by != by) continue;
            ++parts;
            if (densest == nullptr || fraction.fraction > densest->fraction) densest = &fraction;
        }
        if (densest == nullptr || parts < 2 || densest->fraction < worth_naming_fraction ||
            densest->fraction < worth_naming_density * densest->of_samples)
            continue;
        const std::string name = densest->by == "channel" ? channel_words(densest->name) : densest->name;
        sentence += fmt::format("{}{}{} {:.0f}% ({:.0f} to {:.0f}%)", sentence.empty() ? "" : "; ", prefix,
                                name, 1e2 * densest->fraction, 1e2 * densest->low, 1e2 * densest->high);
    }
    return sentence.empty() ? "The gap is spread evenly over the recording."
                            : "The gap is concentrated in (fraction and 95% interval): " + sentence + ".";
}

}  // namespace capstan::gap
