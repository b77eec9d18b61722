#include <gtest/gtest.h>

#include "capstan/bench/waveform.h"

namespace capstan::bench {
namespace {

TEST(Waveform, SinesAddUp) {
    Waveform wave;
    wave.kind = WaveformKind::sines;
    wave.amplitudes = {2.0, 1.0};
    wave.frequency_Hz = {1.0, 3.0};
    wave.phase_rad = {0.0, 0.0};
    EXPECT_DOUBLE_EQ(wave.at(0.0), 0.0);
    EXPECT_NEAR(wave.at(0.25), 2.0 - 1.0, 1e-12) << "crest of the slow one, trough of the fast";
}

TEST(Waveform, RampsBeginAtZeroDwellAndComeBack) {
    Waveform wave;
    wave.kind = WaveformKind::ramps;
    wave.ramp_amplitude = 2.0;
    wave.slope_per_s = 1.0;
    wave.dwell_s = 0.5;
    EXPECT_DOUBLE_EQ(wave.at(0.0), 0.0);
    EXPECT_DOUBLE_EQ(wave.at(1.0), 1.0);
    EXPECT_DOUBLE_EQ(wave.at(2.25), 2.0) << "dwells";
    EXPECT_DOUBLE_EQ(wave.at(4.5), 0.0);
    EXPECT_DOUBLE_EQ(wave.at(6.75), -2.0) << "dwells";
}

TEST(Waveform, StepsRepeatTheirLevels) {
    Waveform wave;
    wave.kind = WaveformKind::steps;
    wave.levels = {1.0, -1.0, 3.0};
    wave.hold_s = 0.1;
    EXPECT_EQ(wave.at(0.05), 1.0);
    EXPECT_EQ(wave.at(0.1), -1.0);
    EXPECT_EQ(wave.at(0.3 - 1e-12), 1.0) << "a time of three holds but for rounding";
    EXPECT_EQ(wave.at(0.55), 3.0);
}

}  // namespace
}  // namespace capstan::bench
