#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capstan/cable/cable_state.h"
#include "capstan/plan/study_plan.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan {

/// The prescribed motion of both ends at a sample.
EndConditions ends_at(const Cable& cable, const TrueMotion& motion, int sample);

/// One sample of a trajectory, with the one before.
struct TrueSample {
    int sample = 0;
    const CableState& previous;
    const CableState& now;
    const StepReport& report;
};

/// Simulates samples 1 to motion.samples and passes each on.
void simulate(const QuasiStaticStep& step, const TrueMotion& motion,
              const std::function<void(const TrueSample&)>& show);

/// The plan's motion as CSV, a line for each sample from 0: time, motion pattern, and tension and
/// displacement of every node.
std::string motion_csv(const StudyPlan& plan);

/// One sample of a trajectory with effects, which has no report.
using ShowStates = std::function<void(int sample, const CableState& previous, const CableState& now)>;

/// The plan's true cable over samples 1 to motion.samples: by the closed-form step, or where it has effects
/// by BenchSimulation on a grid fine enough, read off at the plan's nodes. Throws InvalidInput with
/// problems_of_truth(plan).
void simulate_truth(const StudyPlan& plan, const ShowStates& show);

/// A cable with effects between ends whose positions are given, on a grid fine enough and read off at the
/// nodes of its specification.
class CableWithEffects {
  public:
    CableWithEffects(const CableSpecification& cable, const EffectValues& effects, double sample_rate_Hz);
    ~CableWithEffects();

    const CableState& state() const { return now_; }
    /// The next sample, from 1: how far both ends are from where they rested. False where there is no
    /// solution.
    bool advance(int sample, double proximal_m, double distal_m);

  private:
    struct Bench;
    Cable cable_;
    std::unique_ptr<Bench> bench_;
    CableState now_;
};

/// The reasons why the plan's true cable cannot be simulated; empty if there are none.
std::vector<KeyProblem> problems_of_truth(const StudyPlan& plan);

/// The regime a motion pattern belongs to; none at rest or slack.
std::optional<Regime> regime_of(const MotionPattern& pattern);

}  // namespace capstan
