#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capstan/gap_trial/nuisances.h"
#include "capstan/gap_trial/sensor_chain.h"
#include "capstan/gap_trial/trial_plan.h"

namespace capstan::gap_trial {

/// One true effect, as the label states it.
struct TrueCause {
    std::string effect;
    std::string kind;
    std::string component;
    std::string end;
    std::optional<Stretch> where;
    std::string size_name;
    double size = 0.0;
    std::map<std::string, double> shape;
    double visibility = 0.0;  ///< alone
    std::string clearest_channel;
    std::string varies{};  ///< the run condition that its number follows; empty: none
};

/// The truth of a case.
struct CaseLabel {
    std::string name;
    TruthGroup group = TruthGroup::none;
    std::optional<Severity> severity;  ///< none for `none`
    std::string bench;
    std::vector<std::string> protocols;
    std::vector<TrueCause> causes;
    // Nominal numbers' true ratios.
    double friction_ratio = 1.0;
    double stiffness_ratio = 1.0;
    double pretension_ratio = 1.0;
    std::vector<Nuisance> nuisances;
    std::vector<std::string> conditions;  ///< that the sidecar states for the runs
};

/// Writes a session as a laboratory would: NAME.csv with the samples and NAME.json with the nominal bench.
/// Throws std::runtime_error if they cannot be written.
void write_recording(const std::filesystem::path& folder, const std::string& name, const TrialBench& bench,
                     const std::vector<TrialRun>& runs, const std::vector<SensedRun>& logged);

/// Simulates a planned case and writes its recording under its name in `folder`. Everything is drawn anew
/// (bench, motion, effect) until the effect has its severity. Throws std::runtime_error if that never
/// happens.
CaseLabel make_case(const PlannedCase& planned, const TrialOptions& options,
                    const std::filesystem::path& folder);

/// The same for a rig, whose causes are drawn with it: each gets a visibility of its own.
CaseLabel make_rig_case(const PlannedCase& planned, const TrialOptions& options,
                        const std::filesystem::path& folder);

/// The numbers of one case, a stream for each purpose.
struct CaseStreams {
    TrialStream bench;
    TrialStream motion;
    TrialStream effect;
    TrialStream noise;
    TrialStream nominal;
    TrialStream nuisance;

    CaseStreams(std::uint64_t seed, int index);
};

/// Largest minus smallest value of each channel, over all runs.
std::map<std::string, double> spans_of(const TrialBench& bench, const SensedSession& session);
bool is_finite(const SensedSession& session);
TrueCause as_cause(const WithheldEffect& effect, const SizedEffect& sized);
/// A range around a drawn visibility that is close enough to it.
VisibilityRange around(double visibility);

}  // namespace capstan::gap_trial
