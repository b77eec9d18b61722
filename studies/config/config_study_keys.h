#pragma once
// The rows of the sections of a study's configuration, one source for each group of sections.

#include <filesystem>
#include <optional>
#include <vector>

#include "capstan/config/config_key.h"

namespace capstan::config {

using StudyKeys = std::vector<ConfigKey<StudyPlan>>;

/// Of keys that only studies over worlds have.
inline const KeyCondition<StudyPlan> with_worlds{
    [](const StudyPlan& plan, int) { return plan.uncertainty.is_stated; }, "[uncertainty]"};

void add_conduit_keys(StudyKeys& keys);  ///< [transmission] length_m, centre_line, [[transmission.bend]]
ConfigSection<StudyPlan> bend_section_of_conduit();
/// Makes the pieces of a conduit that is stated otherwise; what is wrong with it. A centre line lies in
/// `folder`; without one the configuration may name no file.
std::vector<KeyProblem> make_pieces(StudyPlan& plan, const KeyLines& lines,
                                    const std::optional<std::filesystem::path>& folder);
void add_layout_keys(StudyKeys& keys);       ///< [layouts]
void add_estimation_keys(StudyKeys& keys);   ///< [estimation]: fusion methods and what they assume
void add_placement_keys(StudyKeys& keys);    ///< [placement], for `capstan place`
void add_sensitivity_keys(StudyKeys& keys);  ///< [sensitivity], for `capstan sensitivity`
void add_uncertainty_keys(StudyKeys& keys);  ///< [uncertainty], [[sensor]] and what they mean for [placement]
std::vector<ConfigSection<StudyPlan>> uncertainty_sections();
void add_sweep_keys(StudyKeys& keys);  ///< [sweep], for many studies from one file

}  // namespace capstan::config
