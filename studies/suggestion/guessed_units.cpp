#include "capstan/suggestion/guessed_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace capstan::imports {

namespace {

constexpr double turn_rad = 2.0 * std::numbers::pi;
// Steps that encoders have, in counts of a turn.
constexpr std::array encoder_counts = {360.0,  400.0,  500.0,   512.0,   720.0,   1000.0,  1024.0,  1440.0,
                                       1800.0, 2000.0, 2048.0,  2500.0,  3600.0,  4000.0,  4096.0,  5000.0,
                                       8000.0, 8192.0, 10000.0, 16384.0, 20000.0, 32768.0, 36000.0, 65536.0};

double closest_counts(double counts) {
    return *std::min_element(encoder_counts.begin(), encoder_counts.end(), [&](double a, double b) {
        return std::abs(std::log(a / counts)) < std::abs(std::log(b / counts));
    });
}

void guess(std::vector<Guess>& guesses, const std::string& about, Doubt doubt, const std::string& reason) {
    guesses.push_back({about, doubt, reason});
}

double lattice_of(const SeenColumn& column) {
    Source source;
    source.column = column.column;
    source.clock.table = column.table;
    source.clock.sample_rate_Hz = 1.0;
    return survey_channel(source, {0, 20000}).step;
}

// Where the file states degrees and the steps are those of an encoder in radians, or the other way round.
void check_stated_angle(const ChannelMapping& channel, const SeenColumn& column, double si,
                        std::vector<Guess>& guesses) {
    const double step = lattice_of(column);
    if (step <= 0.0) return;
    const double counts = turn_rad / (step * si);
    const double others = si == 1.0 ? 360.0 / step : turn_rad / step;
    const auto nice = [](double n) { return n > 90.0 && std::abs(closest_counts(n) / n - 1.0) < 2e-3; };
    if (!nice(counts) && nice(others))
        guess(guesses, channel.name, Doubt::doubtful,
              fmt::format("the file says {}, but its steps of {:.5g} are {:.0f} counts of a turn in {}",
                          column.unit, step, others, si == 1.0 ? "deg" : "rad"));
}

void set_counts(ChannelMapping& channel, const SeenColumn& column, const KnownAngle& other,
                std::vector<Guess>& guesses) {
    // A counter that wraps shows its range.
    if (column.span > 200.0) {
        for (const double counts : encoder_counts) {
            double largest = 0.0;
            for (std::size_t k = 1; k < column.readings.size(); ++k)
                largest = std::max(largest, std::abs(column.readings[k] - column.readings[k - 1]));
            if (column.span < counts && column.span > 0.95 * counts && largest > 0.9 * counts) {
                channel.counts_per_turn = counts;
                guess(guesses, channel.name, Doubt::likely,
                      fmt::format("its counter wraps round at {:.0f}; taken as a turn", counts));
                return;
            }
        }
    }
    // As far as the other angle, if that one has a unit.
    if (other.turns > 0.0) {
        channel.counts_per_turn = closest_counts(column.span / other.turns);
        guess(
            guesses, channel.name, Doubt::doubtful,
            fmt::format(
                "counts_per_turn is a guess from {}, as if both turned equally far; state the encoder's own",
                other.name));
        return;
    }
    channel.counts_per_turn = 4096.0;
    guess(guesses, channel.name, Doubt::doubtful,
          "nothing shows counts_per_turn; 4096 is a placeholder, state the encoder's own");
}

void set_angle_unit(ChannelMapping& channel, const SeenColumn& column, const KnownAngle& other,
                    std::vector<Guess>& guesses) {
    const auto stated = find_unit(column.unit);
    if (stated && stated->quantity == Quantity::angle) {
        channel.unit = std::string(stated->name);
        check_stated_angle(channel, column, stated->si, guesses);
        return;
    }
    if ((stated && stated->quantity == Quantity::counts) || (column.integers_only && column.span > 40.0)) {
        channel.unit = "counts";
        set_counts(channel, column, other, guesses);
        return;
    }
    const double step = lattice_of(column);
    const auto nice = [](double counts) {
        return counts > 90.0 && std::abs(closest_counts(counts) / counts - 1.0) < 2e-3;
    };
    if (step > 0.0 && nice(turn_rad / step) != nice(360.0 / step)) {
        channel.unit = nice(turn_rad / step) ? "rad" : "deg";
        guess(guesses, channel.name, Doubt::likely,
              fmt::format("in {} its steps of {:.5g} are {:.0f} counts of a turn", channel.unit, step,
                          (channel.unit == "rad" ? turn_rad : 360.0) / step));
        return;
    }
    channel.unit = column.span > 2.0 * turn_rad ? "deg" : "rad";
    guess(guesses, channel.name, Doubt::doubtful,
          fmt::format(
              "no unit is stated; it spans {:.3g}, which {}", column.span,
              channel.unit == "deg" ? "is more than two turns in rad" : "is less than two turns in rad"));
}

void set_force_unit(ChannelMapping& channel, const SeenColumn& column, bool is_torque,
                    std::vector<Guess>& guesses) {
    const auto stated = find_unit(column.unit);
    const Quantity wanted = is_torque ? Quantity::torque : Quantity::force;
    if (stated && stated->quantity == wanted) {
        channel.unit = std::string(stated->name);
        return;
    }
    if (is_torque && stated && stated->quantity == Quantity::current) {
        channel.unit = std::string(stated->name);
        channel.torque_constant = 0.05;
        guess(guesses, channel.name, Doubt::doubtful,
              "it is a current; torque_constant_Nm_per_A is a placeholder, state the motor's own");
        return;
    }
    if ((stated && stated->quantity == Quantity::counts) || (column.integers_only && column.span > 100.0)) {
        channel.unit = "counts";
        channel.scale = is_torque ? 1e-3 : 1e-2;
        guess(guesses, channel.name, Doubt::doubtful,
              fmt::format("scale ({} in one count) is a placeholder; state the amplifier's own",
                          is_torque ? "N m" : "N"));
        return;
    }
    const bool large = column.span > (is_torque ? 100.0 : 3000.0);
    channel.unit = is_torque ? (large ? "mN m" : "N m") : (large ? "g" : "N");
    guess(guesses, channel.name, Doubt::doubtful,
          fmt::format("no unit is stated; it spans {:.3g}, which is usual in {}", column.span, channel.unit));
}

}  // namespace

void guess_unit(ChannelMapping& channel, const SeenColumn& column, const KnownAngle& other,
                std::vector<Guess>& guesses) {
    if (channel.name.ends_with("_angle")) {
        set_angle_unit(channel, column, other, guesses);
    } else {
        set_force_unit(channel, column, channel.name.ends_with("_torque"), guesses);
    }
}

}  // namespace capstan::imports
