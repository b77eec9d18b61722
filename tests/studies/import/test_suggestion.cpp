// What a suggestion makes of names that no list has.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "capstan/suggestion/suggestion.h"
#include "imported_folder.h"

namespace capstan::imports {

namespace {

using Suggesting = ImportTest;

TEST_F(Suggesting, TakesNoUnitInANameForAWord) {
    std::string text = "stamp_ms;crank_pos_deg;crank_trq_mNm;knob_pos_deg;knob_trq_mNm\n";
    for (int k = 0; k < 400; ++k) {
        const double angle = 30.0 * std::sin(0.03 * k), friction = std::cos(0.03 * k) > 0.0 ? 20.0 : -20.0;
        text += fmt::format("{};{:.4f};{:.4f};{:.4f};{:.4f}\n", 5000 + 10 * k, angle, 50.0 + friction,
                            0.5 * angle, 80.0 + 0.1 * k);
    }
    const Suggestion suggestion = suggest_mapping({write("a.csv", text)}, {});
    std::vector<std::string> channels;
    for (const ChannelMapping& channel : suggestion.mapping.channels)
        channels.push_back(channel.name + " = " + channel.from.column + " in " + channel.unit);
    EXPECT_THAT(channels, testing::UnorderedElementsAre(
                              "motor_angle = crank_pos_deg in deg", "load_angle = knob_pos_deg in deg",
                              "motor_torque = crank_trq_mNm in mN m", "load_torque = knob_trq_mNm in mN m"));
    EXPECT_EQ(suggestion.mapping.time.unit, "ms");
}

TEST_F(Suggesting, TakesTheLetterOfTheMotorForNoUnit) {
    std::string text = "t_ms,tau_m,phi_m_deg,tau_l,phi_l_deg\n";
    for (int k = 0; k < 400; ++k) {
        const double angle = 30.0 * std::sin(0.03 * k), friction = std::cos(0.03 * k) > 0.0 ? 0.02 : -0.02;
        text += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f}\n", 10 * k, 0.05 + friction, angle,
                            0.08 + 0.0001 * k, 0.5 * angle);
    }
    const Suggestion suggestion = suggest_mapping({write("a.csv", text)}, {});
    std::vector<std::string> channels;
    for (const ChannelMapping& channel : suggestion.mapping.channels)
        channels.push_back(channel.name + " = " + channel.from.column + " in " + channel.unit);
    EXPECT_THAT(channels, testing::UnorderedElementsAre(
                              "motor_angle = phi_m_deg in deg", "load_angle = phi_l_deg in deg",
                              "motor_torque = tau_m in N m", "load_torque = tau_l in N m"));
}

TEST_F(Suggesting, TakesTheLetterOfAMomentForATorque) {
    std::string text = "stamp_ms;q_drive_deg;q_finger_deg;M_drive_mNm;M_finger_mNm\n";
    for (int k = 0; k < 400; ++k) {
        const double angle = 30.0 * std::sin(0.03 * k), friction = std::cos(0.03 * k) > 0.0 ? 20.0 : -20.0;
        text += fmt::format("{};{:.4f};{:.4f};{:.4f};{:.4f}\n", 10 * k, angle, 0.5 * angle, 50.0 + friction,
                            80.0 + 0.1 * k);
    }
    const Suggestion suggestion = suggest_mapping({write("a.csv", text)}, {});
    std::vector<std::string> channels;
    for (const ChannelMapping& channel : suggestion.mapping.channels)
        channels.push_back(channel.name + " = " + channel.from.column);
    EXPECT_THAT(channels,
                testing::UnorderedElementsAre("motor_angle = q_drive_deg", "load_angle = q_finger_deg",
                                              "motor_torque = M_drive_mNm", "load_torque = M_finger_mNm"));
}

TEST_F(Suggesting, TakesAColumnThatNumbersTheRuns) {
    std::string text = "run,t,motor_angle,load_angle,motor_torque,load_torque\n";
    for (int k = 0; k < 400; ++k) {
        const double angle = 0.5 * std::sin(0.03 * k);
        text += fmt::format("{},{:.2f},{:.5f},{:.5f},{:.5f},{:.5f}\n", 1 + k / 200, 0.01 * (k % 200), angle,
                            0.5 * angle, 0.1 + 0.01 * angle, 0.2 + 0.01 * angle);
    }
    const Suggestion suggestion = suggest_mapping({write("a.csv", text)}, {});
    EXPECT_EQ(suggestion.mapping.run_column, "run");
    for (const Finding& finding : suggestion.findings)
        EXPECT_NE(finding.kind, FindingKind::unordered_times) << finding.words;
}

}  // namespace

}  // namespace capstan::imports
