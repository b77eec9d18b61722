#include <gtest/gtest.h>

#include <cmath>

#include "capstan/gap/cause_search.h"
#include "capstan/gap/equivalent_bench.h"
#include "lumped_session.h"
#include "session_with_effects.h"

namespace capstan::gap {
namespace {

// Three causes with two, no and one number of their own.
struct ThreeCauses {
    CandidateCause bend;
    CandidateCause friction;
    CandidateCause lag;

    ThreeCauses() {
        bend.effect = "local_bend";
        bend.numbers.resize(2);
        friction.effect = "param_mu";
        lag.effect = "sensor_lag";
        lag.family = "sensor";
        lag.numbers.resize(1);
        for (CandidateCause* cause : {&bend, &friction, &lag})
            cause->apply = [](BenchNumbers&, std::span<const double>) {};
    }
    Hypothesis together() const {
        return {{&bend, &friction, &lag}, Eigen::VectorXd{{0.1, 0.2, 0.3, 1.0, 2.0, 3.0}}};
    }
};

Recording with_runs_of(const std::vector<std::size_t>& samples) {
    Recording recording;
    for (const std::size_t count : samples) {
        recording.runs.emplace_back();
        recording.runs.back().time_s.resize(count);
    }
    return recording;
}

TEST(Hypothesis, ACauseThatIsAddedComesLastWithItsNumbers) {
    const ThreeCauses known;
    const Hypothesis bend =
        with_cause({{}, Eigen::VectorXd{{0.1, 0.2, 0.3}}}, &known.bend, Eigen::VectorXd{{1.0, 2.0}});
    EXPECT_EQ(bend.coordinates, (Eigen::VectorXd{{0.1, 0.2, 0.3, 1.0, 2.0}}));
    EXPECT_EQ(with_cause(bend, &known.lag, Eigen::VectorXd{{3.0}}).causes.back(), &known.lag);
}

TEST(Hypothesis, KeepingSomeCausesKeepsTheirNumbersAndTheNominalOnes) {
    const ThreeCauses known;
    const Hypothesis kept =
        only_causes(known.together(), [&](const CandidateCause& cause) { return &cause == &known.lag; });
    EXPECT_EQ(kept.causes, std::vector<const CandidateCause*>{&known.lag});
    EXPECT_EQ(kept.coordinates, (Eigen::VectorXd{{0.1, 0.2, 0.3, 3.0}}));
}

TEST(Hypothesis, EachCauseIsLeftOutInTurn) {
    const ThreeCauses known;
    const std::vector<Hypothesis> fewer = without_each(known.together());
    ASSERT_EQ(fewer.size(), 3u);
    EXPECT_EQ(fewer[0].causes, (std::vector<const CandidateCause*>{&known.friction, &known.lag}));
    EXPECT_EQ(fewer[0].coordinates, (Eigen::VectorXd{{0.1, 0.2, 0.3, 3.0}}));
    EXPECT_EQ(fewer[2].coordinates, (Eigen::VectorXd{{0.1, 0.2, 0.3, 1.0, 2.0}}));
}

TEST(Hypothesis, ThoseThatDifferInSensorFaultsOnlyShareABench) {
    const ThreeCauses known;
    Hypothesis other_lag = known.together();
    other_lag.coordinates[5] = 4.0;
    Hypothesis other_bend = known.together();
    other_bend.coordinates[3] = 4.0;
    const std::vector<SameBench> benches =
        by_bench(std::vector<Hypothesis>{known.together(), other_bend, other_lag}, with_runs_of({1}), 0);
    ASSERT_EQ(benches.size(), 2u);
    EXPECT_EQ(benches[0].hypotheses, (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(benches[1].hypotheses, (std::vector<std::size_t>{1}));
}

TEST(Hypothesis, BenchesThatRingAreGroupedApartAndNoGroupExceedsTheLanes) {
    const Recording recording = with_runs_of({5, 7});
    std::vector<SameBench> benches(2 * bench_lanes + 1);
    benches[1].moved.numbers.effects.of<Inertia>().motor_kg_m2 = 1e-5;
    for (std::size_t k = 0; k < benches.size(); k += 3) benches[k].moved.run = 1;
    std::size_t grouped = 0;
    int shortest = 7;
    for (const BenchGroup& group : to_be_moved_at_once(benches, recording)) {
        EXPECT_LE(group.size(), static_cast<std::size_t>(bench_lanes));
        const bool rings = group.front().moved.numbers.rings();
        for (const SameBench& bench : group) {
            EXPECT_EQ(bench.moved.numbers.rings(), rings);
            if (rings) continue;
            EXPECT_LE(recording.runs[bench.moved.run].samples(), shortest) << "long runs go first";
            shortest = recording.runs[bench.moved.run].samples();
        }
        grouped += group.size();
    }
    EXPECT_EQ(grouped, benches.size());
}

TEST(CauseSearch, SortsByEvidenceAndKeepsTheOrderOfEqualFits) {
    std::vector<ScoredFit> fits(3);
    fits[0].evidence = 1.0;
    fits[1].evidence = 2.0;
    fits[2].evidence = 1.0;
    fits[2].misfit = 7.0;
    sort_by_evidence(fits);
    EXPECT_EQ(fits[0].evidence, 2.0);
    EXPECT_EQ(fits[1].misfit, 0.0);
    EXPECT_EQ(fits[2].misfit, 7.0);
}

ScoredFit leaving(double misfit, double visibility, const CandidateCause& cause) {
    ScoredFit fit;
    fit.fit.causes = {&cause};
    fit.misfit = misfit;
    fit.visibility = {visibility};
    return fit;
}

TEST(CauseSearch, LooksForAFurtherCauseOnlyWhereMoreThanNoiseAndLawsErrorIsLeft) {
    ThreeCauses known;
    EXPECT_FALSE(worth_a_further_cause(leaving(1.05, 2.0, known.bend)));  // little beyond noise
    // What a law that is good to a tenth may leave. A wrong number is not a law.
    EXPECT_FALSE(worth_a_further_cause(leaving(3.0, 30.0, known.bend)));
    known.friction.is_exact = true;
    EXPECT_TRUE(worth_a_further_cause(leaving(3.0, 30.0, known.friction)));
    EXPECT_TRUE(worth_a_further_cause(leaving(3.0, 4.0, known.bend)));
}

// Numbers that one bench in a million would have may stand for a cause.
TEST(CauseSearch, LooksForAFurtherCauseBesideNumbersThatAreFarFromThoseStated) {
    const ThreeCauses known;
    ScoredFit fit = leaving(0.7, 2.0, known.bend);
    fit.nominal_penalty = 0.5 * tenable_nominal_penalty;
    EXPECT_FALSE(worth_a_further_cause(fit));
    fit.nominal_penalty = 20.0;
    EXPECT_TRUE(worth_a_further_cause(fit));
}

// Wide numbers take up a part of the floor.
TEST(CauseSearch, LooksBelowTheFloorWhereTheBenchsNumbersFloat) {
    ThreeCauses known;
    BenchKnowledge built = measured_bench();
    built.numbers.push_back({.name = "zero", .kind = FloatingNumber::Kind::zero, .apply = {}});
    ScoredFit fit = leaving(0.8, 2.0, known.bend);
    EXPECT_FALSE(worth_a_further_cause(fit));
    fit.fit.bench = &built;
    EXPECT_TRUE(worth_a_further_cause(fit));
    fit.misfit = 0.2;
    EXPECT_FALSE(worth_a_further_cause(fit));
}

// There nothing says that what is left is only the model's own error (E54).
TEST(CauseSearch, LooksForAFurtherCauseWhateverIsLeftWhereTheScaleOfItIsNotKnown) {
    const ThreeCauses known;
    ScoredFit fit = leaving(0.1, 2.0, known.bend);
    EXPECT_FALSE(worth_a_further_cause(fit));
    fit.has_unknown_scales = true;
    EXPECT_TRUE(worth_a_further_cause(fit));
}

TEST(CauseSearch, OutOfTimeItGivesTheNominalFitAndSaysSo) {
    Recording recording = exact_session({}, coarse_twin);
    recording.runs.resize(1);
    CauseSearchOptions options;
    options.segments = 10;
    options.stride = 4;
    options.time_limit_s = 0.0;
    CauseSearch search(recording, options);
    const FoundCauses found = search.run();
    EXPECT_TRUE(found.cut_short);
    ASSERT_EQ(found.fits.size(), 1u);
    EXPECT_EQ(found.fits.front().fit.causes.front()->effect, "none");
}

struct FoundFit {
    std::string causes;
    Eigen::VectorXd coordinates;
    double evidence = 0.0;

    bool operator==(const FoundFit&) const = default;
};

std::vector<FoundFit> found_with_threads(const Recording& recording, int threads) {
    CauseSearchOptions options;
    options.segments = 10;
    options.stride = recording.nominal_is_fitted ? 1 : 4;
    options.threads = threads;
    CauseSearch search(recording, options);
    std::vector<FoundFit> found;
    for (const ScoredFit& each : search.run().fits)
        found.push_back({in_words(each.fit.causes), each.fit.coordinates, each.evidence});
    return found;
}

// Fits are made side by side, and pruned by those before them.
TEST(CauseSearch, FindsTheSameOnAMeasuredBenchWithAnyNumberOfThreads) {
    BenchNumbers numbers;
    numbers.effects.of<ViscousFriction>().drag_N_s_per_m2 = 3.0;
    numbers.effects.of<MotorCogging>() = {0.02, 0.0, 7.0};
    const Recording recording = exact_session(numbers, coarse_twin);
    const std::vector<FoundFit> alone = found_with_threads(recording, 1);
    EXPECT_TRUE(alone.front().causes.starts_with("motor cogging with ")) << alone.front().causes;
    EXPECT_EQ(alone, found_with_threads(recording, 3));
}

TEST(CauseSearch, FindsTheSameOnADriveWithAnyNumberOfThreads) {
    Recording drive = lumped_session({});
    for (RecordedRun& run : drive.runs) {
        for (std::size_t sample = 0; sample < run.time_s.size(); ++sample)
            run.values[0][sample] += 0.05 * std::sin(6.0 * run.values[1][sample] + 1.0);
    }
    const Recording bench = equivalent_bench(drive, drive);
    const std::vector<FoundFit> alone = found_with_threads(bench, 1);
    EXPECT_EQ(alone.front().causes, "motor cogging");
    EXPECT_EQ(alone, found_with_threads(bench, 3));
}

TEST(CauseSearch, StartsWithTheNominalModelAndReportsGrowingProgress) {
    Recording recording = exact_session({}, coarse_twin);
    recording.runs.resize(1);
    std::vector<double> fractions;
    CauseSearchOptions options;
    options.segments = 10;
    options.stride = 4;
    options.threads = 1;
    options.on_progress = [&](const std::string&, double fraction_done) {
        fractions.push_back(fraction_done);
    };
    CauseSearch search(recording, options);
    const FoundCauses found = search.run();
    EXPECT_EQ(fractions.front(), 0.0);
    EXPECT_LT(found.nominal_misfit, 1.0);
    EXPECT_GT(found.evaluations, 0);
    EXPECT_TRUE(std::all_of(found.fits.begin(), found.fits.end(), [](const ScoredFit& each) {
        return each.fit.causes.size() == 1;
    })) << "nothing is left for a second cause";
    EXPECT_TRUE(
        std::is_sorted(found.fits.begin(), found.fits.end(),
                       [](const ScoredFit& a, const ScoredFit& b) { return a.evidence > b.evidence; }));
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

}  // namespace
}  // namespace capstan::gap
