#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/gap_trial/trial_motion.h"
#include "capstan/gap_trial/visibility.h"
#include "capstan/gap_trial/withheld_effect.h"

namespace capstan::gap_trial {

enum class SeverityChoice { mild, strong, both };

/// The kind of truth of a case.
enum class TruthGroup { none, catalogue, parameter, foreign, mixture, three };

/// What a trial's recordings are like.
enum class TrialKind {
    benches,  ///< four benches, one cause each as a rule, nominal numbers right
    rigs,  ///< drawn geometry, nuisances, wrong nominal numbers, up to three unequal causes, hand-like motion
};

std::string truth_group_name(TruthGroup group);
/// The group of that name, or nothing.
std::optional<TruthGroup> truth_group_named(std::string_view name);

/// The options of a trial. The same options give the same recordings, bit for bit.
struct TrialOptions {
    int cases = 60;
    std::uint64_t seed = 1;
    SeverityChoice severity = SeverityChoice::both;
    double noise_factor = 1.0;
    RecordingLength length = RecordingLength::standard;
    /// Standard deviation of the laboratory's error in friction, stiffness and pretension (logarithms); 0:
    /// none.
    double nominal_error = 0.0;
    TrialKind kind = TrialKind::benches;
    /// Of each effect, drawn for each on its own (log-uniform), in place of `severity`. Rigs: 0.5 to 10.
    std::optional<VisibilityRange> visibility = std::nullopt;
    double mixtures = 0.10;  ///< fraction of the cases with two effects, of benches
    bool nuisances = false;  ///< sensor zeros and pulley friction on benches; rigs always have them
    /// All cases of this kind, in place of the mix of plan_trial.
    std::optional<TruthGroup> only = std::nullopt;
};

/// Adds what decides the recordings, but for the number of cases.
void add_options(nlohmann::ordered_json& json, const TrialOptions& options);
/// The options as trial.json states them.
std::string options_text(const TrialOptions& options);
std::string severity_choice_name(SeverityChoice choice);
std::string length_name(RecordingLength length);
std::string trial_kind_name(TrialKind kind);

/// "case007"
std::string case_name(int number);

/// True if the session can show what the maker draws.
bool fits(const EffectMaker& maker, const TrialBench& bench, const std::vector<TrialRun>& runs);

/// The family by which a near miss is judged, such as "friction law". `none` and `unknown` are families of
/// their own.
std::string effect_family(const std::string& effect);

struct PlannedCase {
    int index = 0;  ///< address of its random numbers
    std::string name;
    TruthGroup group = TruthGroup::none;
    Severity severity = Severity::strong;
    std::vector<EffectMaker> makers;  ///< none, one, or two
    // Of a rig, whose makers are drawn with it:
    BenchKind bench = BenchKind::rig_pair;
    int causes = 0;
    bool has_conditions = false;
    bool varies = false;  ///< one of the causes is a number that follows the condition
};

/// The mix: 10% without a gap, 12% outside the catalogue, 10% (or as stated) of two effects together, 9%
/// wrong parameters, the rest spread evenly over the catalogue and the severities, in random order. Mixtures
/// are strong where both severities are asked for. Or one group alone (TrialOptions::only).
std::vector<PlannedCase> plan_trial(const TrialOptions& options);

/// The mix of rigs: a tenth without a cause, 35% with one, 30% with two, 25% with three; a third are drives,
/// of the others a quarter single cables; 40% state a condition of their runs, and in half of these a number
/// follows it.
std::vector<PlannedCase> plan_rigs(const TrialOptions& options);

}  // namespace capstan::gap_trial
