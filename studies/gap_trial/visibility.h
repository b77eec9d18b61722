#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/gap_trial/sensor_chain.h"
#include "capstan/gap_trial/withheld_effect.h"

namespace capstan::gap_trial {

/// A session as its sensors give it without noise.
using SensedSession = std::vector<SensedRun>;

/// How far an effect stands out of what a lab could not tell from nothing.
struct Visibility {
    double ratio = 0.0;  ///< rms change over noise and floor together, of the channel where it is largest
    std::string channel;
};

/// A session without an effect, and how it moves with the numbers that a lab knows only roughly.
struct Baseline {
    SensedSession sensed;
    std::vector<SensedSession> with_more;  ///< friction, stiffness, pretension, each by `more_log`
    static constexpr double more_log = 0.02;
};

/// What is left of a change when friction, stiffness and pretension are each moved by up to 3%, as best
/// imitates it: a change that they explain is none that anybody could find. In units of noise and of the
/// floor: by how much a converged quasi-static model misses this bench without any effect (ringing and
/// inertia; measured with the engine's twin and rounded).
Visibility visibility(const TrialBench& bench, const std::vector<TrialRun>& runs, const Baseline& baseline,
                      const SensedSession& with);

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
    const TrueEffects& before;          ///< what is wrong anyway, like nominal numbers a percent off
    const std::vector<TrueRun>& truth;  ///< with that
    const Baseline& baseline;           ///< of the same
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
                                 const TrueEffects& effects);
Baseline make_baseline(const TrialBench& bench, const std::vector<TrialRun>& runs, const TrueEffects& before,
                       const SensedSession& sensed);
SensedSession sense_session(const TrialBench& bench, const std::vector<TrueRun>& truth,
                            const TrueEffects& effects);

}  // namespace capstan::gap_trial
