#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/gap_trial/sensor_chain.h"
#include "capstan/gap_trial/withheld_effect.h"

namespace capstan::gap_trial {

/// A session as its sensors measure it without noise.
using SensedSession = std::vector<SensedRun>;

/// How clearly an effect can be seen in a session.
struct Visibility {
    double ratio = 0.0;  ///< rms change over noise and floor together, of the channel where it is largest
    std::string channel;
};

/// A session without an effect, and its change with the nominal numbers, which a laboratory knows only
/// roughly.
struct Baseline {
    SensedSession sensed;
    std::vector<SensedSession> with_more;  ///< friction, stiffness, pretension, each by `more_log`
    static constexpr double more_log = 0.02;
};

/// How far the nominal numbers are free to reproduce a change.
struct NominalFreedom {
    double max_move_log = 0.03;  ///< friction, stiffness, pretension, each
    bool zeros_float = false;    ///< of all channels
};

/// The part of a change that remains when friction, stiffness and pretension each vary by up to 3% (or as
/// stated) to reproduce it. A change that they reproduce cannot be attributed to an effect. In units of noise
/// and of the model's floor, which is the error of a converged quasi-static model of this bench without any
/// effect (oscillation and inertia; measured with the engine's twin and rounded).
Visibility visibility(const TrialBench& bench, const std::vector<TrialRun>& runs, const Baseline& baseline,
                      const SensedSession& with, const NominalFreedom& freedom = {});

enum class Severity { mild, strong };

std::string severity_name(Severity severity);

/// Visibility that counts as mild (1.5 to 3) or strong (4 to 10).
struct VisibilityRange {
    double low = 0.0;
    double high = 0.0;
};
VisibilityRange range_of(Severity severity);

/// The bench that an effect of a size is put into.
struct EffectTrial {
    const TrialBench& bench;
    const std::vector<TrialRun>& runs;
    const TrueEffects& before;          ///< without the effect; nominal numbers may be a percent off
    const std::vector<TrueRun>& truth;  ///< with that
    const Baseline& baseline;           ///< of the same
    NominalFreedom freedom{};
    LumpedBenchOptions simulated{};
};

struct SizedEffect {
    double size = 0.0;
    Visibility visibility;
};

/// A size at which the effect's visibility lies in the range, near `wanted`; none if no bench could have it.
std::optional<SizedEffect> find_size(const EffectTrial& trial, const WithheldEffect& effect,
                                     const VisibilityRange& range, double wanted);

/// All runs with these effects; each on its own, in the order of the session.
std::vector<TrueRun> run_session(const TrialBench& bench, const std::vector<TrialRun>& runs,
                                 const TrueEffects& effects, const LumpedBenchOptions& options = {});
Baseline make_baseline(const TrialBench& bench, const std::vector<TrialRun>& runs, const TrueEffects& before,
                       const SensedSession& sensed, const LumpedBenchOptions& options = {});
SensedSession sense_session(const TrialBench& bench, const std::vector<TrueRun>& truth,
                            const TrueEffects& effects);

}  // namespace capstan::gap_trial
