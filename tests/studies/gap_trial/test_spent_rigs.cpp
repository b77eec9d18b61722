// Recordings from spent seeds of the trial, each of which a diagnosis once missed: rigs, drives of unknown
// geometry, and benches with one or two protocols and nominal numbers 1% off.
// The simulator knows nothing of the engine. Most are labelled slow: half a minute of both processors and
// more.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "capstan/gap/cause_fit.h"
#include "capstan/gap/diagnosis.h"
#include "capstan/gap/equivalent_bench.h"
#include "capstan/gap_trial/trial_case.h"
#include "capstan/recording/recording_reader.h"
#include "nearly_certain.h"
#include "scratch_folder.h"

namespace capstan::gap_trial {
namespace {

Recording recorded_rig(std::uint64_t seed, int number, int cases) {
    TrialOptions options;
    options.seed = seed;
    options.cases = cases;
    const PlannedCase planned = plan_rigs(options).at(static_cast<std::size_t>(number - 1));
    const ScratchFolder folder;
    const CaseLabel label = make_rig_case(planned, options, folder.path());
    const Recording rig = read_recording(folder.path() / (label.name + ".csv"));
    return gap::equivalent_bench(rig, rig);
}

gap::Diagnosis diagnosed(std::uint64_t seed, int number, int cases = 40) {
    return gap::diagnose(recorded_rig(seed, number, cases), {});
}

gap::Diagnosis diagnosed_short(std::uint64_t seed, int number, int cases = 120) {
    TrialOptions options;
    options.seed = seed;
    options.cases = cases;
    options.length = RecordingLength::brief;
    options.nominal_error = 0.01;
    const PlannedCase planned = plan_trial(options).at(static_cast<std::size_t>(number - 1));
    const ScratchFolder folder;
    const CaseLabel label = make_case(planned, options, folder.path());
    return gap::diagnose(read_recording(folder.path() / (label.name + ".csv")), {});
}

// Of the harder kind: with zeros and friction of bearings, and causes from 0.5 to 10 times noise and floor.
gap::Diagnosis diagnosed_hard(std::uint64_t seed, int cases, int number) {
    TrialOptions options;
    options.seed = seed;
    options.cases = cases;
    options.nuisances = true;
    options.visibility = VisibilityRange{0.5, 10.0};
    options.mixtures = 0.4;
    options.nominal_error = 0.01;
    const PlannedCase planned = plan_trial(options).at(static_cast<std::size_t>(number - 1));
    const ScratchFolder folder;
    const CaseLabel label = make_case(planned, options, folder.path());
    return gap::diagnose(read_recording(folder.path() / (label.name + ".csv")), {});
}

double present(const gap::Diagnosis& diagnosis, const std::string& effect) {
    for (const gap::RankedEffect& each : diagnosis.ranked) {
        if (each.effect == effect) return each.present;
    }
    return 0.0;
}

// The start that is best without a cause leads a drive with lost motion of 0.02 rad to a misfit of 227.
TEST(SlowSpentRigs, LargeLostMotionIsNamedBesideAStiffeningCable) {
    const gap::Diagnosis diagnosis = diagnosed(84517, 38);
    EXPECT_GT(present(diagnosis, "backlash"), gap::nearly_certain);
    EXPECT_GT(present(diagnosis, "cable_stiffness_nonlinear"), gap::nearly_certain);
    EXPECT_LT(diagnosis.misfit_after, 1.0);
}

// The numbers of this drive make up for half of its lost motion at the motor, and beside them a search sets
// it to nothing.
TEST(SpentRigs, HeldSizesLeadToALostMotionThatLooksWorseThanNone) {
    const Recording recording = recorded_rig(394101, 2, 24);
    const gap::CauseFitter fitter(recording, {.segments = 9, .stride = 1}, 2);
    const gap::BenchKnowledge bench = gap::undescribed_bench(recording);
    gap::Hypothesis slack = gap::nominal_hypothesis(bench);
    slack.coordinates[2] = -1.0;  // the pretension
    gap::CauseFitter::FitOptions options;
    options.any_size = false;
    options.balanced = true;
    const gap::CauseFit without = fitter.fit(slack, options);
    Eigen::VectorXd left = without.residuals;
    fitter.apply(without.weights, left);

    const std::vector<gap::CandidateCause> causes = gap::candidate_causes(recording);
    const auto backlash = std::find_if(causes.begin(), causes.end(), [](const gap::CandidateCause& cause) {
        return cause.effect == "backlash" && cause.variant == "motor";
    });
    ASSERT_NE(backlash, causes.end());
    const gap::Hypothesis start =
        gap::with_cause(without.hypothesis(), &*backlash, Eigen::VectorXd::Constant(1, 0.5));
    EXPECT_GT(fitter.rough_fit({&start, 1}, without.weights).sum_of_squares, 0.9 * left.squaredNorm());
    const auto held = fitter.rough_fit_from_held_sizes(start, without.weights);
    ASSERT_TRUE(held);
    EXPECT_LT(held->sum_of_squares, 0.7 * left.squaredNorm());
}

// Without what follows the bending of the drive, the zero of its load torque makes up for it.
TEST(SlowSpentRigs, FrictionThatFollowsAConditionIsNamedBesideCreepAndARipple) {
    const gap::Diagnosis diagnosis = diagnosed(77341, 4);
    for (const char* effect : {"param_mu", "creep", "motor_cogging"})
        EXPECT_GT(present(diagnosis, effect), gap::nearly_certain) << effect;
}

// A torque that depends on the position, or a zero that follows a condition, stands for a ripple at first.
TEST(SlowSpentRigs, ARipplePreslidingAndAStiffeningCableAreNamedTogether) {
    const gap::Diagnosis diagnosis = diagnosed(46213, 3);
    for (const char* effect : {"cable_stiffness_nonlinear", "presliding", "motor_cogging"})
        EXPECT_GT(present(diagnosis, effect), gap::nearly_certain) << effect;
}

// Presliding, 2 of noise and floor. Hysteresis of the load cell explains it too, with friction, stiffness and
// pretension that one bench in a million would have beside those stated, and leads. No third cause does.
TEST(SlowSpentRigs, OnlyHysteresisOfTheLoadCellCompetesWithPresliding) {
    const gap::Diagnosis diagnosis = diagnosed(90731, 39);
    EXPECT_GT(present(diagnosis, "presliding"), 0.05);
    EXPECT_GT(present(diagnosis, "presliding") + present(diagnosis, "sensor_hysteresis"),
              gap::nearly_certain);
}

// An encoder is read when its count is latched: a lag of a sample and a half is not what every encoder has. A
// delay does much the same to so slow a motion.
TEST(SlowSpentRigs, ASlowAngleIsToldBesideACauseThatIsFaintBesideTheNumbersOfTheBench) {
    const gap::Diagnosis diagnosis = diagnosed(90731, 22);
    EXPECT_GT(present(diagnosis, "sensor_lag") + present(diagnosis, "time_misalignment"),
              gap::nearly_certain);
    EXPECT_GT(present(diagnosis, "cable_stiffness_nonlinear"), 0.3);
}

// A ripple of seven periods and a torque over the position fit almost as well.
TEST(SlowSpentRigs, ARippleOfFivePeriodsIsNoTorqueOverThePosition) {
    const gap::Diagnosis diagnosis = diagnosed(441209, 1);
    EXPECT_GT(present(diagnosis, "motor_cogging"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "position_torque"), 0.3);
}

// Where the ratio of the pulleys does not float, a pulley that is not round corrects it.
TEST(SlowSpentRigs, ARatioThatWasMisreadIsNoEccentricPulley) {
    const gap::Diagnosis diagnosis = diagnosed(118903, 5);
    EXPECT_GT(present(diagnosis, "creep"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "eccentric_pulley"), 0.3);
}

// With a loop that closes exponentially, an environment coupling corrected what is left at its reversals.
TEST(SlowSpentRigs, ALoopOfASensorIsNotAnEnvironmentCoupling) {
    const gap::Diagnosis diagnosis = diagnosed(996101, 28);
    for (const char* effect : {"sensor_hysteresis", "motor_cogging"})
        EXPECT_GT(present(diagnosis, effect), gap::nearly_certain) << effect;
    EXPECT_LT(present(diagnosis, "environment_coupling"), 0.3);
}

// With an exponent of 1, a compliance corrected how its friction builds up.
TEST(SlowSpentRigs, PreslidingOfADriveIsNoCompliance) {
    const gap::Diagnosis diagnosis = diagnosed(107101, 30);
    EXPECT_GT(present(diagnosis, "presliding"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "conduit_compliance"), 0.3);
}

// The lag has several stages. What a lag of first order gets wrong of them looked like a delay besides.
TEST(SlowSpentRigs, ALagOfSeveralStagesIsNotNamedADelayToo) {
    const gap::Diagnosis diagnosis = diagnosed(774501, 33);
    EXPECT_GT(present(diagnosis, "sensor_lag"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "time_misalignment"), 0.1);
}

// Creep alone closes 98% of what the two do, and the delay alone with numbers that are far from those stated.
TEST(SlowSpentBenches, APairIsNamedThoughOneOtherCauseClosesNearlyAll) {
    const gap::Diagnosis diagnosis = diagnosed_short(107203, 43);
    EXPECT_GT(present(diagnosis, "cable_stiffness_nonlinear"), 0.7);
    // A lag leaves a little more than the delay, and both less than noise and floor.
    EXPECT_GT(present(diagnosis, "time_misalignment"), present(diagnosis, "sensor_lag"));
    EXPECT_GT(present(diagnosis, "time_misalignment") + present(diagnosis, "sensor_lag"),
              gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "creep"), 0.2);
}

// The coarse model shows an inertia beside it, and a gain with an inertia leaves less.
TEST(SlowSpentBenches, FrictionThatDiffersByDirectionIsNotAGain) {
    const gap::Diagnosis diagnosis = diagnosed_short(996203, 34);
    EXPECT_GT(present(diagnosis, "directional_friction"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "sensor_gain"), 0.1);
}

// A little friction of the motor's bearing shows nothing, and bending stiffness stood for it.
TEST(SpentBenches, FrictionOfTheMotorsBearingIsNoBendingStiffness) {
    const gap::Diagnosis diagnosis = diagnosed_short(885203, 66);
    EXPECT_GT(present(diagnosis, "pulley_friction"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "bending_stiffness"), 0.1);
}

// Fronts make ripples in the sum of squares, at one of which a search with small differences ended.
TEST(SpentBenches, BendingStiffnessIsFoundBeyondTheRipplesOfFronts) {
    const gap::Diagnosis diagnosis = diagnosed_short(107203, 41);
    EXPECT_GT(present(diagnosis, "bending_stiffness"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "local_bend"), 0.1);
}

// The search for the two ended in a minimum that left twice as much as noise and floor; with a compliance
// that does nothing it went on.
TEST(SpentRigs, LostMotionIsNamedBesideAnInertia) {
    const gap::Diagnosis diagnosis = diagnosed(328101, 10, 16);
    for (const char* effect : {"backlash", "inertia"})
        EXPECT_GT(present(diagnosis, effect), gap::nearly_certain) << effect;
}

// A delay of four samples was already among the numbers of the bench when causes were screened, so that only
// a lag seemed to change anything.
TEST(SpentRigs, ADelayIsNamedThoughTheBenchHasItsNumber) {
    const gap::Diagnosis diagnosis = diagnosed(339101, 2, 32);
    EXPECT_GT(present(diagnosis, "time_misalignment"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "sensor_lag"), 0.1);
}

// Screened beside wrong numbers of the bench the ripple had 21 periods a turn instead of seven, and a cause
// outside the list led.
TEST(SpentRigs, ARippleOfSevenPeriodsIsFoundBesideTwoCauses) {
    const gap::Diagnosis diagnosis = diagnosed(339101, 17, 32);
    for (const char* effect : {"motor_cogging", "backlash"})
        EXPECT_GT(present(diagnosis, effect), gap::nearly_certain) << effect;
    EXPECT_LT(present(diagnosis, "unknown"), 0.1);
}

// A held load feels no front before it comes. Where friction built up over 3 um it did, and a hysteresis and
// a zero that follows the temperature stood for that.
TEST(SpentRigs, ASingleCableWithoutAGapHasNone) {
    const gap::Diagnosis diagnosis = diagnosed(427101, 25);
    for (const char* effect : {"sensor_hysteresis", "conduit_compliance"})
        EXPECT_LT(present(diagnosis, effect), 0.1) << effect;
    for (const gap::RankedEffect& each : diagnosis.ranked) {
        if (each.present >= 0.3) {
            EXPECT_EQ(each.varies, "") << each.effect;
        }
    }
}

// When a motor turned round is known to some samples of a coarse encoder. A lag of the torque sensor, beside
// an advance of its time, made the friction of the bearing fit before and after.
TEST(SpentRigs, ACoarseEncoderNeedsNoLagOfTheTorque) {
    EXPECT_LT(present(diagnosed(438101, 31), "sensor_lag"), 0.1);
}

// The floating numbers took up most of the presliding, and the screening beside them did not show it.
// What its creep and its zero, which follows the roll, leave looks like a torque that is half a sample early.
TEST(SpentRigs, AFaintDelayBesideClearCausesIsNone) {
    EXPECT_LT(present(diagnosed(506101, 20), "time_misalignment"), 0.1);
}

TEST(SpentRigs, FindsAPreslidingThatTheNumbersOfADriveHide) {
    EXPECT_GT(present(diagnosed(461101, 14), "presliding"), 0.8);
}

TEST(SlowSpentRigs, ACoarseEncoderNeedsNoLagBesideLoadDependentFriction) {
    const gap::Diagnosis diagnosis = diagnosed(438101, 12);
    EXPECT_GT(present(diagnosis, "load_dependent_friction"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "sensor_lag"), 0.1);
}

// The torque of an inertia came a step late, and a delay stood for that.
TEST(SlowSpentRigs, AnInertiaOfTheLoadNeedsNoDelayOfItsTorque) {
    const gap::Diagnosis diagnosis = diagnosed(405101, 14);
    EXPECT_GT(present(diagnosis, "inertia"), gap::nearly_certain);
    for (const char* effect : {"time_misalignment", "stribeck"})
        EXPECT_LT(present(diagnosis, effect), 0.1) << effect;
}

// The set that left least also held a cause that does nothing. The hysteresis was not named then.
TEST(SlowSpentBenches, AHysteresisIsNotHiddenByACauseThatDoesNothing) {
    const gap::Diagnosis diagnosis = diagnosed_short(107203, 40);
    EXPECT_GT(present(diagnosis, "sensor_hysteresis"), gap::nearly_certain);
}

// Sets of the pair and one of the numbers had not been fitted, so that nothing told how little each number
// closes.
TEST(SlowSpentBenches, TwoWrongNumbersAreNotNamedBesideAPairThatLeavesNothing) {
    const gap::Diagnosis diagnosis = diagnosed_short(339203, 4, 32);
    for (const char* effect : {"presliding", "conduit_compliance"})
        EXPECT_GT(present(diagnosis, effect), gap::nearly_certain) << effect;
    for (const char* effect : {"param_mu", "param_T0"}) EXPECT_LT(present(diagnosis, effect), 0.1) << effect;
}

// On a bench without zeros and friction of bearings, a bend beside the motor closes what these do beside the
// two causes, and leaves no more than noise and floor.
TEST(SlowSpentBenches, ABendDoesNotStandForWhatIsUsualBesideAPair) {
    const gap::Diagnosis diagnosis = diagnosed_hard(239407, 32, 20);
    for (const char* effect : {"conduit_compliance", "sensor_gain"})
        EXPECT_GT(present(diagnosis, effect), gap::nearly_certain) << effect;
    EXPECT_LT(present(diagnosis, "local_bend"), 0.1);
}

// The noise of the tensions is larger than what the bend changes, but averages out.
TEST(SpentBenches, ABendThatNoiseHidesIsNamed) {
    const gap::Diagnosis diagnosis = diagnosed_hard(262407, 16, 1);
    EXPECT_GT(present(diagnosis, "local_bend"), gap::nearly_certain);
    EXPECT_LT(present(diagnosis, "none"), 0.1);
}

TEST(SlowSpentBenches, PreslidingThatNoiseHidesIsNamedAlone) {
    const gap::Diagnosis diagnosis = diagnosed_hard(262407, 16, 6);
    EXPECT_GT(present(diagnosis, "presliding"), gap::nearly_certain);
    for (const char* effect : {"sensor_hysteresis", "local_bend", "conduit_compliance"})
        EXPECT_LT(present(diagnosis, effect), 0.1) << effect;
}

// A zero, bearings' friction and the like stand for no part of a friction 5% off on a single cable.
TEST(SpentBenches, AFrictionThatIsALittleOffIsNamedBesideZerosAndBearings) {
    const gap::Diagnosis diagnosis = diagnosed_hard(262407, 16, 7);
    EXPECT_GT(present(diagnosis, "param_mu"), 0.5);
    EXPECT_LT(present(diagnosis, "none"), 0.5);
}

// Without the run that moves, the other one does not tell how slow the sensor is, so that neither a lag nor a
// delay closes anything on held-out data.
TEST(SpentBenches, ALagThatOnlyOneRunTellsIsASlowSensor) {
    const gap::Diagnosis diagnosis = diagnosed_short(162203, 47);
    EXPECT_GT(present(diagnosis, "sensor_lag") + present(diagnosis, "time_misalignment"), 0.8);
}

// The best explanation of the bench as built is a loop of the angle's sensor, the second best what is there.
// On the measured bench, which needs no numbers of its own, that is better by far.
TEST(SpentBenches, TheSecondBestOfABenchAsBuiltMayBeTheBestOfTheMeasuredOne) {
    const gap::Diagnosis diagnosis = diagnosed_short(449203, 93, 100);
    for (const char* effect : {"pulley_friction", "sensor_gain"})
        EXPECT_GT(present(diagnosis, effect), gap::nearly_certain) << effect;
    EXPECT_LT(present(diagnosis, "sensor_hysteresis"), 0.1);
}

// A viscous bearing with a delay of the angle led. With the viscous cable in the place of the bearing the
// delay does nothing.
TEST(SpentBenches, AViscousCableInThePlaceOfABearingNeedsNoDelay) {
    const gap::Diagnosis diagnosis = diagnosed_hard(449407, 100, 27);
    for (const char* effect : {"viscous_friction", "cable_stiffness_nonlinear"})
        EXPECT_GT(present(diagnosis, effect), 0.8) << effect;
    for (const char* effect : {"pulley_friction", "time_misalignment"})
        EXPECT_LT(present(diagnosis, effect), 0.1) << effect;
}

// The torque of the load is 0.7 samples late, which is usual of a force, and changes it by 1.6 times noise
// and floor.
TEST(SpentBenches, ADelayThatShowsIsNamedAlthoughItIsUsual) {
    const gap::Diagnosis diagnosis = diagnosed_hard(473407, 60, 20);
    EXPECT_GT(present(diagnosis, "time_misalignment"), 0.8);
    EXPECT_LT(present(diagnosis, "none"), 0.1);
}

// A lag in two stages of 8.5 ms, 1.7 samples, is nearly a delay.
TEST(SpentBenches, ALagThatADelayNearlyExplainsIsNamed) {
    const gap::Diagnosis diagnosis = diagnosed_hard(506407, 80, 66);
    EXPECT_GT(present(diagnosis, "sensor_lag"), 0.8);
    EXPECT_LT(present(diagnosis, "time_misalignment"), 0.1);
}

// Its values are 2.3 steps of the encoder apart. There are 1,387 of them in 8,003 samples.
TEST(SpentBenches, AnEncoderThatIsCoarserThanStatedIsCoarse) {
    const gap::Diagnosis diagnosis = diagnosed_hard(495407, 50, 38);
    EXPECT_GT(present(diagnosis, "sensor_quantization"), 0.8);
    EXPECT_LT(present(diagnosis, "unknown"), 0.1);
}

// The stiffness alone, 6.5% off, leaves less than half of noise and floor.
TEST(SpentBenches, AStiffnessThatIsFarOffIsNoAbsenceOfAGap) {
    const gap::Diagnosis diagnosis = diagnosed_short(885203, 91);
    EXPECT_GT(present(diagnosis, "param_K"), 0.8);
    EXPECT_LT(present(diagnosis, "none"), 0.2);
}

}  // namespace
}  // namespace capstan::gap_trial
