#include "capstan/suggestion/column_roles.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "capstan/import/log_files.h"
#include "capstan/import/units.h"
#include "capstan/rig/channel_names.h"

namespace capstan::imports {

namespace {

constexpr std::size_t seen_readings = 60000;

using Words = std::vector<std::string>;

// "Back-end CUI Encoder" and "motorPos_deg" as words in lower case.
Words words_of(const std::string& name) {
    Words words;
    std::string word;
    char before = ' ';
    for (const char c : name) {
        const auto letter = static_cast<unsigned char>(c);
        const bool new_word = std::isupper(letter) && std::islower(static_cast<unsigned char>(before));
        if (!std::isalnum(letter) || new_word) {
            if (!word.empty()) words.push_back(word);
            word.clear();
        }
        if (std::isalnum(letter)) word += static_cast<char>(std::tolower(letter));
        before = c;
    }
    if (!word.empty()) words.push_back(word);
    return words;
}

// "crank_trq_mNm" without its unit, which is not a word.
Words words_of_column(const SeenColumn& column) {
    const std::string& name = column.column->name;
    const bool ends_with_unit =
        column.column->unit.empty() && !column.unit.empty() && name.ends_with(column.unit);
    return words_of(ends_with_unit ? name.substr(0, name.size() - column.unit.size()) : name);
}

bool has_any(const Words& words, std::initializer_list<const char*> wanted) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
        return std::any_of(wanted.begin(), wanted.end(), [&](const std::string& want) {
            return want.size() > 3 ? word.starts_with(want) : word == want;
        });
    });
}

constexpr std::initializer_list<const char*> motor_words = {
    "motor",   "input", "in",  "proximal", "prox",    "drive", "driver", "actuator", "act",
    "spindle", "winch", "mot", "m",        "antrieb", "back",  "theta1", "q1",       "tau1"};
constexpr std::initializer_list<const char*> load_words = {
    "load",   "output", "out",   "distal", "dist",    "joint", "jaw",    "tip",
    "handle", "knob",   "wrist", "elbow",  "link",    "l",     "last",   "front",
    "theta2", "q2",     "tau2",  "finger", "gripper", "tool",  "abtrieb"};
constexpr std::initializer_list<const char*> angle_words = {
    "angle", "ang", "pos", "position", "theta", "theta1",   "theta2", "encoder",
    "enc",   "q",   "q1",  "q2",       "phi",   "rotation", "winkel", "alpha"};
constexpr std::initializer_list<const char*> torque_words = {
    "torque", "tau", "tau1", "tau2", "trq", "tq", "moment", "effort", "futek", "drehmoment", "mz"};
constexpr std::initializer_list<const char*> tension_words = {"tension", "force", "loadcell", "cell",
                                                              "strain",  "ft",    "fz",       "kraft"};

// In "M_finger" the letter stands for a moment; in "q_m" and "tau_m", where no other word names an end, for
// the motor.
void read_lone_m(Words& words) {
    const auto letter = std::find(words.begin(), words.end(), "m");
    if (letter == words.end()) return;
    words.erase(letter);
    words.emplace_back(has_any(words, motor_words) || has_any(words, load_words) ? "moment" : "m");
}

}  // namespace

std::vector<SeenColumn> seen_columns(const std::vector<const logs::Log*>& logs) {
    std::vector<SeenColumn> seen;
    for (const logs::Log* log : logs) {
        for (const logs::LogTable& table : log->tables) {
            for (const logs::LogColumn& column : table.columns) {
                SeenColumn own{log, &table, &column, stated_unit(column),
                               logs::numbers_of(column.values, seen_readings)};
                double before = 0.0;
                const auto first = std::find_if(own.readings.begin(), own.readings.end(),
                                                [](double value) { return std::isfinite(value); });
                if (first == own.readings.end()) continue;
                before = *first;
                double low = before;
                double high = before;
                own.integers_only = true;
                std::size_t rises = 0;
                for (double& value : own.readings) {
                    if (!std::isfinite(value)) value = before;
                    own.integers_only &= value == std::round(value);
                    rises += value > before ? 1u : 0u;
                    low = std::min(low, value);
                    high = std::max(high, value);
                    before = value;
                }
                own.span = high - low;
                own.rising = static_cast<double>(rises) > 0.9 * static_cast<double>(own.readings.size() - 1);
                if (own.span > 0.0) seen.push_back(std::move(own));
            }
        }
    }
    return seen;
}

bool is_command(const SeenColumn& column) {
    return has_any(words_of(column.column->name), {"command", "cmd", "target", "desired", "des", "setpoint",
                                                   "reference", "ref", "goal", "error", "pwm", "voltage"});
}

bool is_run_number(const SeenColumn& column) {
    constexpr std::size_t rows_of_a_run = 20;
    std::size_t changes = 0;
    for (std::size_t k = 1; k < column.readings.size(); ++k)
        changes += column.readings[k] != column.readings[k - 1] ? 1u : 0u;
    return column.integers_only && changes * rows_of_a_run < column.readings.size() &&
           has_any(words_of_column(column), {"run", "trial", "session", "versuch", "lauf"});
}

double name_fits(const SeenColumn& column, const std::string& channel) {
    Words words = words_of_column(column);
    for (const std::string& word : words_of(column.table->name)) words.push_back(word);
    read_lone_m(words);
    const auto unit = find_unit(column.unit);
    const bool is_angle = channel.ends_with("_angle");
    const bool is_torque = channel.ends_with("_torque");
    double score = 0.0;
    if (is_angle || is_torque) {
        const bool motor = channel.starts_with("motor");
        const bool says_motor = has_any(words, motor_words);
        const bool says_load = has_any(words, load_words);
        if (says_motor != says_load) score += (says_motor == motor) ? 0.4 : -0.6;
        if (has_any(words, is_angle ? angle_words : torque_words)) score += 0.4;
        if (has_any(words, is_angle ? torque_words : angle_words)) score -= 0.6;
        if (has_any(words, {"velocity", "vel", "speed", "accel", "acceleration", "omega"})) score -= 0.8;
        if (is_torque && has_any(words, {"current", "amps"})) score += motor ? 0.15 : -0.3;
        if (has_any(words, tension_words) && !has_any(words, is_angle ? angle_words : torque_words))
            score -= 0.3;
        if (unit) {
            const Quantity wanted = is_angle ? Quantity::angle : Quantity::torque;
            if (unit->quantity == wanted) {
                score += 0.3;
            } else if (unit->quantity == Quantity::force && is_torque) {
                score -= 0.5;
            } else if (unit->quantity != Quantity::counts && unit->quantity != Quantity::current) {
                score -= 0.6;
            }
        }
    } else {  // a tension
        if (has_any(words, tension_words)) score += 0.5;
        if (has_any(words, torque_words) || has_any(words, angle_words)) score -= 0.5;
        if (unit) score += unit->quantity == Quantity::force ? 0.4 : -0.5;
    }
    if (is_command(column)) score -= 0.8;
    return std::clamp(score, 0.0, 1.0);
}

}  // namespace capstan::imports
