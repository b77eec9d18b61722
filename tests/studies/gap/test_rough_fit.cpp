// Searches that begin with what is known from others.
#include <gtest/gtest.h>

#include <algorithm>

#include "capstan/gap/cause_fit.h"
#include "session_with_effects.h"

namespace capstan::gap {
namespace {

// A bench as built, with friction that grows with speed, which its numbers have made up for.
class FurtherCauseBesideFittedNumbers : public testing::Test {
  protected:
    FurtherCauseBesideFittedNumbers() : recording_(recorded()), bench_(built_bench(recording_)) {
        causes_ = candidate_causes(recording_);
        drag_ = &*std::find_if(causes_.begin(), causes_.end(), [](const CandidateCause& cause) {
            return cause.effect == "viscous_friction";
        });
        CauseFitter::FitOptions options;
        options.any_size = false;
        options.balanced = true;
        without_ = fitter_.fit(nominal_hypothesis(bench_), options);
    }

    static Recording recorded() {
        BenchNumbers numbers;
        numbers.effects.of<ViscousFriction>().drag_N_s_per_m2 = 3.0;
        return exact_session(numbers, coarse_twin);
    }
    Hypothesis start() const {
        return with_cause(without_.hypothesis(), drag_, Eigen::VectorXd::Constant(1, 1.0));
    }

    Recording recording_;
    BenchKnowledge bench_;
    CauseFitter fitter_{recording_, {.segments = 12, .stride = 4}, 1};
    std::vector<CandidateCause> causes_;
    const CandidateCause* drag_ = nullptr;
    CauseFit without_;
};

TEST_F(FurtherCauseBesideFittedNumbers, WideDerivativesAreDifferencesOfTheResiduals) {
    const Hypothesis found = without_.hypothesis();
    const WideDerivatives wide = fitter_.wide_derivatives(found);
    EXPECT_EQ(wide.at, found.coordinates);
    ASSERT_EQ(wide.jacobian.cols(), found.coordinates.size());
    for (Eigen::Index k = 0; k < found.coordinates.size(); ++k) {
        std::vector<Hypothesis> both = {found, found};
        both[1].coordinates[k] += 0.1;
        const Eigen::MatrixXd residuals = fitter_.data_residuals(both);
        EXPECT_EQ(wide.residuals, residuals.col(0));
        EXPECT_TRUE(wide.jacobian.col(k).isApprox((residuals.col(1) - residuals.col(0)) / 0.1, 1e-9)) << k;
    }
}

TEST_F(FurtherCauseBesideFittedNumbers, IsFittedRoughlyInFewerSimulationsWhereTheirDerivativesAreKnown) {
    const Hypothesis from = start();
    const CauseFit all = fitter_.rough_fit({&from, 1}, without_.weights);
    const CauseFit own =
        fitter_.rough_fit({&from, 1}, without_.weights, fitter_.wide_derivatives(without_.hypothesis()));
    EXPECT_LT(own.evaluations, all.evaluations);
    Eigen::VectorXd before = without_.residuals;
    fitter_.apply(without_.weights, before);
    ASSERT_LT(all.sum_of_squares, 0.2 * before.squaredNorm());
    EXPECT_LT(own.sum_of_squares, 0.2 * before.squaredNorm());
}

TEST_F(FurtherCauseBesideFittedNumbers, DerivativesThatAreKnownElsewhereChangeNothing) {
    const Hypothesis from = start();
    Hypothesis elsewhere = without_.hypothesis();
    elsewhere.coordinates[0] += 0.5;
    const CauseFit alone = fitter_.rough_fit({&from, 1}, without_.weights);
    const CauseFit other =
        fitter_.rough_fit({&from, 1}, without_.weights, fitter_.wide_derivatives(elsewhere));
    EXPECT_EQ(alone.coordinates, other.coordinates);
    EXPECT_EQ(alone.evaluations, other.evaluations);
}

TEST_F(FurtherCauseBesideFittedNumbers, AFitThatBeginsWhereACoarserOneEndedTakesFewerSimulations) {
    CauseFitter::FitOptions options;
    options.any_size = false;
    options.balanced = true;
    const CauseFit coarse = fitter_.fit(start(), options);
    const CauseFitter fine(recording_, {.segments = 24, .stride = 2}, 1);
    const CauseFit far = fine.fit(coarse.hypothesis(), options);
    options.is_close = true;
    const CauseFit close = fine.fit(coarse.hypothesis(), options);
    EXPECT_LT(close.evaluations, far.evaluations);
    EXPECT_LT(fine.misfit(close), 1.05 * fine.misfit(far));
}

}  // namespace
}  // namespace capstan::gap
