#include <gtest/gtest.h>

#include "capstan/gap/screening.h"
#include "session_with_effects.h"

namespace capstan::gap {
namespace {

const Hypothesis nominal{{}, Eigen::VectorXd::Zero(nominal_coordinates)};

std::vector<CandidateCause> only_named(const Recording& recording, const std::vector<std::string>& effects) {
    std::vector<CandidateCause> causes = candidate_causes(recording);
    std::erase_if(causes, [&](const CandidateCause& cause) {
        return std::find(effects.begin(), effects.end(), cause.effect) == effects.end();
    });
    return causes;
}

TEST(Screening, PutsTheTrueCauseFirstAndStartsNearItsSize) {
    BenchNumbers numbers;
    numbers.effects.of<ViscousFriction>().drag_N_s_per_m2 = 2.0;
    const Recording recording = exact_session(numbers, coarse_twin);
    const CauseFitter fitter(recording, coarse_twin, 1);
    const std::vector<CandidateCause> causes =
        only_named(recording, {"viscous_friction", "creep", "sensor_offset", "local_bend"});
    const std::vector<Screened> screened = screen(fitter, causes, nominal);
    ASSERT_FALSE(screened.empty());
    EXPECT_EQ(screened.front().cause->effect, "viscous_friction");
    const OpenNumber& drag = screened.front().cause->numbers.front();
    EXPECT_NEAR(drag.value(screened.front().start[0]), 2.0, 0.6);
}

TEST(Screening, ListsEveryCauseOnceAndNeitherNoneNorWhatIsPresent) {
    const Recording recording = exact_session({}, coarse_twin);
    const CauseFitter fitter(recording, coarse_twin, 1);
    const std::vector<CandidateCause> causes =
        only_named(recording, {"none", "param_mu", "viscous_friction", "sensor_lag"});
    const auto drag = std::find_if(causes.begin(), causes.end(), [](const CandidateCause& cause) {
        return cause.effect == "viscous_friction";
    });
    const Hypothesis present{{&*drag}, Eigen::VectorXd::Zero(nominal_coordinates + 1)};
    const std::vector<Screened> screened = screen(fitter, causes, present);
    EXPECT_EQ(screened.size(), causes.size() - 2);
    for (const Screened& each : screened) {
        EXPECT_NE(each.cause->effect, "none");
        EXPECT_NE(each.cause, &*drag);
    }
}

// A gain and a soft hand: neither explains the recording alone, and each other cause that does in part is
// more promising than either.
TEST(Screening, PutsTheTruePairFirst) {
    BenchNumbers numbers;
    numbers.effects.of<EnvironmentCoupling>().compliance_rad_per_Nm = 3e-3;
    numbers.sensor_faults["load_torque"].gain = 1.2;
    const Recording recording = exact_session(numbers, coarse_twin);
    const CauseFitter fitter(recording, coarse_twin, 1);
    const std::vector<CandidateCause> causes =
        only_named(recording, {"none", "param_mu", "inertia", "viscous_friction", "sensor_gain", "creep",
                               "environment_coupling", "local_bend", "bending_stiffness"});
    const std::vector<ScreenedPair> pairs = screen_pairs(fitter, causes, nominal);
    ASSERT_FALSE(pairs.empty());
    EXPECT_EQ(pairs.front().first->effect, "environment_coupling");
    EXPECT_EQ(pairs.front().second->variant, "load_torque");
    const OpenNumber& gain = pairs.front().second->numbers.front();
    EXPECT_NEAR(gain.value(pairs.front().start_of_second[0]), 1.2, 0.05);
    EXPECT_LT(pairs.front().sum_of_squares, screen(fitter, causes, nominal).front().sum_of_squares);
    for (const ScreenedPair& pair : pairs) {
        EXPECT_NE(pair.first, pair.second);
        for (const CandidateCause* cause : {pair.first, pair.second}) {
            EXPECT_FALSE(cause->numbers.empty()) << cause->effect;
            EXPECT_TRUE(cause->effect != "inertia" || cause->variant == "load");
        }
    }
}

// An oscillation explains something only where its frequency is met within a few hundredths.
TEST(Screening, FindsAnInertiaThatRingsWhateverItsSize) {
    for (const double inertia_kg_m2 : {2.3e-4, 9.1e-4}) {
        BenchNumbers numbers;
        numbers.effects.of<Inertia>().motor_kg_m2 = inertia_kg_m2;
        const Recording recording = exact_session(numbers, coarse_twin);
        const CauseFitter fitter(recording, coarse_twin, 1);
        const std::vector<CandidateCause> causes =
            only_named(recording, {"inertia", "viscous_friction", "param_K"});
        const std::vector<Screened> screened = screen(fitter, causes, nominal);
        ASSERT_FALSE(screened.empty());
        EXPECT_EQ(screened.front().cause->variant, "motor");
        EXPECT_NEAR(screened.front().cause->numbers.front().value(screened.front().start[0]) / inertia_kg_m2,
                    1.0, 0.07);
    }
}

// Friction of a bearing that holds the motor back over much of the motion changes other things than a little
// of it does.
TEST(Screening, FindsAFrictionOfABearingOfWhichALittleShowsNothing) {
    for (const double coulomb_Nm : {0.01, 0.03}) {
        BenchNumbers numbers;
        numbers.effects.of<PulleyFriction>().motor.coulomb_Nm = coulomb_Nm;
        const Recording recording = exact_session(numbers, coarse_twin);
        const CauseFitter fitter(recording, coarse_twin, 1);
        const std::vector<CandidateCause> causes =
            only_named(recording, {"pulley_friction", "bending_stiffness", "local_bend", "motor_cogging"});
        const std::vector<Screened> screened = screen(fitter, causes, nominal);
        ASSERT_FALSE(screened.empty());
        EXPECT_EQ(screened.front().cause->effect, "pulley_friction") << coulomb_Nm;
    }
}

// A ripple of six periods a turn is told from those of other numbers of periods, the most promising first.
TEST(Screening, PutsTheStartWithTheTrueNumberOfPeriodsFirst) {
    BenchNumbers numbers;
    numbers.effects.of<MotorCogging>() = {0.02, -0.01, 6.0};
    const Recording recording = exact_session(numbers, coarse_twin);
    const CauseFitter fitter(recording, coarse_twin, 1);
    const std::vector<CandidateCause> causes = only_named(recording, {"motor_cogging"});
    ASSERT_EQ(causes.size(), 1u);
    const std::vector<OpenNumber>& own = causes.front().numbers;
    const auto periods = std::find_if(own.begin(), own.end(), [](const OpenNumber& number) {
        return number.kind == OpenNumber::Kind::periods;
    });
    ASSERT_NE(periods, own.end());
    const std::vector<Screened> screened = screen_each_start(fitter, causes.front(), nominal, {});
    ASSERT_EQ(screened.size(), periods->starts().size());
    EXPECT_EQ(periods->value(screened.front().start[periods - own.begin()]), 6.0);
    EXPECT_LT(screened.front().sum_of_squares, 0.5 * screened[1].sum_of_squares);
}

// Of many numbers of periods only the most promising are screened again, beside another cause.
TEST(Screening, KeepsTheTrueNumberOfPeriodsAmongThePromisingStarts) {
    BenchNumbers numbers;
    numbers.effects.of<MotorCogging>() = {0.02, -0.01, 6.0};
    numbers.effects.of<ViscousFriction>().drag_N_s_per_m2 = 2.0;
    const Recording recording = exact_session(numbers, coarse_twin);
    const CauseFitter fitter(recording, coarse_twin, 1);
    const std::vector<CandidateCause> causes = only_named(recording, {"motor_cogging", "viscous_friction"});
    const auto cogging = std::find_if(causes.begin(), causes.end(), [](const CandidateCause& cause) {
        return cause.effect == "motor_cogging";
    });
    const auto start_of_cogging = [&](const std::vector<Screened>& screened) {
        const auto found = std::find_if(screened.begin(), screened.end(),
                                        [&](const Screened& each) { return each.cause == &*cogging; });
        return found == screened.end() ? Eigen::VectorXd() : found->start;
    };
    PromisingStarts promising;
    screen(fitter, causes, nominal, {}, &promising);
    ASSERT_EQ(promising.size(), 1u);
    EXPECT_LT(promising.at(&*cogging).size(), screen_each_start(fitter, *cogging, nominal, {}).size() / 2);
    const auto drag = std::find_if(causes.begin(), causes.end(), [](const CandidateCause& cause) {
        return cause.effect != "motor_cogging";
    });
    Hypothesis present{{&*drag}, Eigen::VectorXd::Zero(nominal_coordinates + 1)};
    present.coordinates[nominal_coordinates] = 1.0;
    const Eigen::VectorXd start = start_of_cogging(screen(fitter, causes, present));
    ASSERT_GT(start.size(), 0);
    EXPECT_EQ(start_of_cogging(screen(fitter, causes, present, {}, &promising)), start);
}

// Half a degree of freedom: drag cannot be negative, so a bench with too little of it gains nothing from it.
TEST(Screening, ASizeThatCannotBeNegativeExplainsNothingTheOtherWay) {
    Recording recording = exact_session({}, coarse_twin);
    BenchNumbers more;
    more.effects.of<ViscousFriction>().drag_N_s_per_m2 = 2.0;
    const Recording draggy = exact_session(more, coarse_twin);
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            std::vector<double>& values = recording.runs[run].values[channel];
            if (recording.runs[run].drives(recording.channels[channel].name)) continue;
            for (std::size_t sample = 0; sample < values.size(); ++sample)
                values[sample] -= draggy.runs[run].values[channel][sample] - values[sample];
        }
    }
    const CauseFitter fitter(recording, coarse_twin, 1);
    std::vector<CandidateCause> causes = only_named(recording, {"viscous_friction", "param_mu"});
    std::erase_if(causes, [](const CandidateCause& cause) { return cause.is_of_runs; });
    const std::vector<Screened> screened = screen(fitter, causes, nominal);
    ASSERT_EQ(screened.size(), 2u);
    const auto sum_of = [&](const std::string& effect) {
        return std::find_if(screened.begin(), screened.end(),
                            [&](const Screened& each) { return each.cause->effect == effect; })
            ->sum_of_squares;
    };
    // Wrong friction has no number of its own: what is left is what the nominal numbers leave.
    EXPECT_NEAR(sum_of("viscous_friction") / sum_of("param_mu"), 1.0, 1e-3);
}

}  // namespace
}  // namespace capstan::gap
