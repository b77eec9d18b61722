#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "capstan/plan/study_plan.h"
#include "capstan/recording/recording.h"

namespace capstan::duty {

struct DutyOptions {
    /// A cable both of whose ends move slower than this stands still, whatever an encoder's noise says.
    double still_m_per_s = 2e-4;
    int segments = 100;  ///< of the model that says which nodes move
    /// What a calibration saved; nothing: the sidecar's nominal numbers.
    std::optional<std::filesystem::path> parameters;
    int jobs = 0;  ///< threads; 0: all processors
};

/// Time that cables spent in each kind of motion [s]; of a pull-pull pair both cables count, half each.
struct MotionTimes {
    double still_s = 0.0;
    double slack_s = 0.0;
    std::vector<double> regime_s = std::vector<double>(std::size(all_regimes), 0.0);  // as all_regimes

    double moving_s() const;
    double total_s() const { return still_s + slack_s + moving_s(); }
};

struct DutyCycle {
    std::vector<MotionTimes> runs;  ///< as the recording's
    MotionTimes all;
    int unsolved_steps = 0;  ///< steps of the model whose motion did not verify

    /// Fraction of the moving time; they sum to 1. Throws InvalidInput if nothing moved.
    double fraction(Regime regime) const;
};

/// Moves the recording's model with its driven channels and looks at which nodes slide in each sample. Throws
/// InvalidInput where the bench's geometry is not known: which nodes move follows from it.
DutyCycle measure_duty(const Recording& recording, const DutyOptions& options);

/// The plan with duty shares as measured: those of its regimes, made to sum to 1. Returns the fraction of the
/// moving time that was spent in regimes which the plan does not have. Throws InvalidInput if that is all.
double use_duty(const DutyCycle& duty, StudyPlan& plan);

}  // namespace capstan::duty
