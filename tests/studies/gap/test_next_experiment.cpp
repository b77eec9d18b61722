#include <gtest/gtest.h>

#include <random>

#include "capstan/gap/next_experiment.h"
#include "sample_recording.h"

namespace capstan::gap {
namespace {

// Torque ramps against a locked load, and no sensor between the ends, on a bench with a tight bend that the
// model does not know.
Recording ramps_of_a_bent_bench() {
    Recording recording = driven_session();
    recording.channels.pop_back();
    recording.tension_sensors.clear();
    recording.runs.resize(1);
    recording.runs.front().values.resize(recording.channels.size());
    BenchNumbers bent;
    bent.effects.of<LocalBend>() = {.extra_angle_rad = 0.15, .middle_m = 0.4, .length_m = 0.2};
    const TwinRun truth = EffectsTwin(recording, {80, 1}).run(0, bent);
    std::mt19937_64 random(20260303);
    std::normal_distribution<double> normal;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        if (truth.values[channel].empty()) continue;
        recording.runs.front().values[channel] = truth.values[channel];
        for (double& value : recording.runs.front().values[channel])
            value += sample_noise(recording.channels[channel]) * normal(random);
    }
    return recording;
}

class BendOrFriction : public testing::Test {
  protected:
    const Recording recording = ramps_of_a_bent_bench();
    const std::vector<CandidateCause> causes = candidate_causes(recording);
    const CauseFitter fitter{recording, {40, 1}, 2};

    ScoredFit fitted(const std::string& effect, const std::string& variant,
                     const std::vector<double>& numbers) const {
        for (const CandidateCause& cause : causes) {
            if (cause.effect != effect || cause.variant != variant) continue;
            Hypothesis start{
                {&cause},
                Eigen::VectorXd::Zero(nominal_coordinates + static_cast<Eigen::Index>(numbers.size()))};
            for (std::size_t k = 0; k < numbers.size(); ++k)
                start.coordinates[nominal_coordinates + static_cast<Eigen::Index>(k)] = numbers[k];
            ScoredFit fit;
            fit.fit = fitter.fit(start, {});
            return fit;
        }
        throw std::out_of_range(effect);
    }

    double discrimination_probability(const NonIdentifiable& result, const std::string& start_of_name) const {
        double most = 0.0;
        for (const ExperimentScore& each : result.experiments) {
            if (each.name.starts_with(start_of_name)) most = std::max(most, each.discrimination_probability);
        }
        return most;
    }
};

TEST_F(BendOrFriction, IsDistinguishedBetterByASensorBeyondTheBendThanByOneBeforeIt) {
    const ScoredFit bend = fitted("local_bend", "both cables", {0.2, 0.2, 0.0});
    const ScoredFit friction = fitted("param_mu", "", {});
    const std::vector<WeighedHypothesis> group = {{{"local_bend"}, {}, 0.5, 0.0, &bend},
                                                  {{"param_mu"}, {}, 0.5, 0.0, &friction}};
    const NonIdentifiable result = discriminating_experiments(recording, fitter, group, 2);
    ASSERT_FALSE(result.experiments.empty());
    EXPECT_GT(discrimination_probability(result, "tension sensor on cable A at 1.00 m"),
              discrimination_probability(result, "tension sensor on cable A at 0.10 m") + 0.02);
    // Where a hand moves the load, all of the cable slides, and nothing tells where it is bent.
    EXPECT_GT(discrimination_probability(result, "tension sensor on cable A at 1.00 m"),
              discrimination_probability(result, "moving hand") + 0.02);
}

TEST_F(BendOrFriction, NoExperimentDistinguishesAnExplanationFromItself) {
    const ScoredFit friction = fitted("param_mu", "", {});
    const std::vector<WeighedHypothesis> group = {{{"param_mu"}, {}, 0.5, 0.0, &friction},
                                                  {{"param_mu"}, {}, 0.5, 0.0, &friction}};
    for (const ExperimentScore& each : discriminating_experiments(recording, fitter, group, 1).experiments)
        EXPECT_NEAR(each.discrimination_probability, 0.5, 0.01) << each.name;
}

TEST_F(BendOrFriction, GivesTheSameAnswerForAnyNumberOfThreads) {
    const ScoredFit bend = fitted("local_bend", "both cables", {0.2, 0.2, 0.0});
    const ScoredFit friction = fitted("param_mu", "", {});
    const std::vector<WeighedHypothesis> group = {{{"local_bend"}, {}, 0.5, 0.0, &bend},
                                                  {{"param_mu"}, {}, 0.5, 0.0, &friction}};
    const NonIdentifiable one = discriminating_experiments(recording, fitter, group, 1);
    const NonIdentifiable seven = discriminating_experiments(recording, fitter, group, 7);
    ASSERT_EQ(one.experiments.size(), seven.experiments.size());
    for (std::size_t k = 0; k < one.experiments.size(); ++k) {
        EXPECT_EQ(one.experiments[k].name, seven.experiments[k].name);
        EXPECT_EQ(one.experiments[k].discrimination_probability,
                  seven.experiments[k].discrimination_probability);
    }
}

TEST(NonIdentifiable, IsEmptyWhereTheFirstIsCertain) {
    const ScoredFit any;
    EXPECT_TRUE(non_identifiable(std::vector<WeighedHypothesis>{{{"creep"}, {}, 0.96, 0.0, &any},
                                                                {{"backlash"}, {}, 0.04, -3.0, &any}})
                    .empty());
}

TEST(NonIdentifiable, LeavesOutExplanationsThatCannotBeSimulated) {
    const ScoredFit any;
    const std::vector<WeighedHypothesis> weighed = {{{"unknown"}, {}, 0.4, 0.0, nullptr, true},
                                                    {{"creep"}, {}, 0.3, -0.3, &any},
                                                    {{"backlash"}, {}, 0.26, -0.4, &any},
                                                    {{"inertia"}, {}, 0.04, -3.0, &any}};
    const auto group = non_identifiable(weighed);
    ASSERT_EQ(group.size(), 2u);
    EXPECT_EQ(group[0].effects.front(), "creep");
    EXPECT_EQ(group[1].effects.front(), "backlash");
}

TEST(NonIdentifiable, OfAnUnknownCauseAreTheKnownOnesThatComeClosest) {
    const ScoredFit any;
    const std::vector<WeighedHypothesis> weighed = {{{"unknown"}, {}, 0.98, 0.0, &any, true},
                                                    {{"creep"}, {}, 0.01, -5.0, &any},
                                                    {{"none"}, {}, 0.006, -5.5, &any},
                                                    {{"backlash"}, {}, 0.004, -6.0, &any}};
    ASSERT_TRUE(is_probably_unknown(weighed));
    const auto group = non_identifiable(weighed);
    ASSERT_EQ(group.size(), 2u);
    EXPECT_EQ(group[0].effects.front(), "creep");
    EXPECT_EQ(group[1].effects.front(), "backlash");
}

TEST(PossibleExperiments, StayWithinTheTorqueThatTheRecordingShows) {
    const Recording recording = ramps_of_a_bent_bench();
    const auto most = [](const Recording& any) {
        double torque = 0.0;
        for (const double value : any.runs.front().values[0]) torque = std::max(torque, std::abs(value));
        return torque;
    };
    for (const Experiment& experiment : possible_experiments(recording))
        EXPECT_LE(most(experiment.recording), most(recording) * (1.0 + 1e-12)) << experiment.name;
}

}  // namespace
}  // namespace capstan::gap
