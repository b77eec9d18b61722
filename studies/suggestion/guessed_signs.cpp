#include "capstan/suggestion/guessed_signs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/suggestion/column_motion.h"
#include "capstan/platform/statistics.h"
#include "capstan/rig/channel_names.h"

namespace capstan::imports {

namespace {

// Below this size a correlation shows no direction.
constexpr double clear_correlation = 0.3;
// Below this part of what could be, a work shows no direction.
constexpr double clear_work = 0.05;

/// The channels whose signs are guessed.
class SignGuesses {
  public:
    SignGuesses(Mapping& mapping, const ChosenColumns& chosen, std::vector<Guess>& guesses)
        : mapping_(mapping), chosen_(chosen), guesses_(guesses) {}

    // Motor and load turn the same way when cable A pulls, and friction takes work from the motor.
    void find() {
        const SeenColumn* motor = chosen(channel::motor_angle);
        const SeenColumn* load = chosen(channel::load_angle);
        const SeenColumn* torque = chosen(channel::motor_torque);
        const SeenColumn* load_torque = chosen(channel::load_torque);
        if (motor != nullptr && load != nullptr && motor->table == load->table) {
            const double alike = correlation(motor->readings, load->readings);
            if (alike < -clear_correlation) {
                mapped(channel::load_angle)->sign = -1.0;
                guess(
                    channel::load_angle, Doubt::likely,
                    fmt::format(
                        "sign = -1: it falls as the motor's angle rises (correlation {:.2f}), and cable A turns both the "
                        "same way",
                        alike));
            } else if (std::abs(alike) < clear_correlation) {
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

  private:
    const SeenColumn* chosen(const std::string& name) const {
        const auto found = std::find_if(chosen_.begin(), chosen_.end(),
                                        [&](const auto& entry) { return entry.first == name; });
        return found == chosen_.end() ? nullptr : found->second;
    }
    ChannelMapping* mapped(const std::string& name) const {
        return &*std::find_if(mapping_.channels.begin(), mapping_.channels.end(),
                              [&](const ChannelMapping& channel) { return channel.name == name; });
    }
    void guess(const std::string& about, Doubt doubt, const std::string& reason) {
        guesses_.push_back({about, doubt, reason});
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
        const double together = std::abs(alike) > clear_correlation
                                    ? alike
                                    : mean_of(torque.readings) * mean_of(load_torque.readings);
        const double load_sign = together < 0.0 ? -1.0 : 1.0;
        const double motor_J = work_J(channel::motor_torque, torque, channel::motor_angle, motor);
        const double load_J =
            load_sign * work_J(channel::load_torque, load_torque, channel::load_angle, load);
        const double lost_J = motor_J - load_J;
        const double turned = lost_J < 0.0 ? -1.0 : 1.0;
        mapped(channel::motor_torque)->sign = turned;
        mapped(channel::load_torque)->sign = turned * load_sign;
        const bool clear = std::abs(lost_J) > clear_work * (std::abs(motor_J) + std::abs(load_J));
        if (turned < 0.0)
            guess(channel::motor_torque, clear ? Doubt::likely : Doubt::doubtful,
                  fmt::format("sign = -1: else motor and load together would take {:.3g} J out of friction",
                              -lost_J));
        else if (!clear)
            guess(channel::motor_torque, Doubt::doubtful,
                  "the work lost to friction is too small to show its sign");
        if (turned * load_sign < 0.0 || std::abs(alike) < clear_correlation)
            guess(channel::load_torque, std::abs(alike) < clear_correlation ? Doubt::doubtful : Doubt::likely,
                  std::abs(alike) < clear_correlation
                      ? "its correlation with the motor's torque is below 0.3, so its sign is a guess"
                      : "sign = -1: it is positive where it acts as the motor's torque does");
    }

    // Right where the motor drives; a hand that turns it would show the other sign.
    void sign_by_motor(const SeenColumn& motor, const SeenColumn& torque) {
        const double work = loop_work(torque.readings, motor.readings);
        const double size = torque.span * motor.span;
        const double angle_sign = mapped(channel::motor_angle)->sign;
        if (work * angle_sign < -clear_work * size) {
            mapped(channel::motor_torque)->sign = -1.0;
            guess(
                channel::motor_torque, Doubt::doubtful,
                "sign = -1: else the motor would take work from the transmission over closed loops, as it does only where "
                "a hand turns the load");
        } else if (work * angle_sign < clear_work * size) {
            guess(channel::motor_torque, Doubt::doubtful,
                  "its loop over the motor's angle is too narrow to show its sign");
        }
    }

    Mapping& mapping_;
    const ChosenColumns& chosen_;
    std::vector<Guess>& guesses_;
};

}  // namespace

void guess_signs(Mapping& mapping, const ChosenColumns& chosen, std::vector<Guess>& guesses) {
    SignGuesses(mapping, chosen, guesses).find();
}

}  // namespace capstan::imports
