#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/blind_trial/causes_score.h"
#include "capstan/blind_trial/sealed_labels.h"
#include "capstan/blind_trial/trial_answer.h"
#include "capstan/recording/recording.h"

namespace capstan::gap_trial {

/// The scores of one group of cases. Of two true effects either counts as a hit.
struct GroupScore {
    std::string by;  ///< "all", "truth", "effect", "severity", "bench", "runs"
    std::string name;
    Fraction top1;
    Fraction top3;
    Fraction family;  ///< of the effect that leads
};

struct Calibration {
    /// Mean over cases of the squared distance of the stated probabilities from the truth (Brier 1950): 0 is
    /// perfect, 2 the worst. Two true effects hold half of the truth each.
    double brier = 0.0;
    /// Expected calibration error: mean gap between stated and found, weighted by cases, in ten bins. The
    /// stated probability is that of all effects named together, and all of them must be there.
    double ece = 0.0;
    double ece_by_chance = 0.0;        ///< its mean if every probability is right
    std::vector<ReliabilityBin> bins;  ///< those that hold a case
};

/// The gap that the named causes leave, relative to the gap that the true causes leave: on runs held out,
/// where the answer states that.
struct Shrinkage {
    int cases = 0;
    double median_before = 0.0;  ///< relative to the gap that the true cause leaves, as all three
    double median_after = 0.0;   ///< by the diagnosis
    Fraction as_good_as_truth;   ///< leaves at most 10% more
};

struct TrialScore {
    std::vector<GroupScore> groups;  ///< the first is of all cases
    Fraction false_alarms;           ///< something named where there is nothing
    Fraction missed_gaps;            ///< `none` where there is something
    Fraction foreign_found;          ///< `unknown` where the cause is outside the catalogue
    Fraction needless_unknown;       ///< `unknown` where the catalogue has the cause
    Fraction both_of_mixtures;       ///< the first two are the two
    Calibration calibration;
    CausesScore causes;
    // Of single causes that lead the answer.
    Fraction component;
    Fraction end;    ///< where the truth has one
    Fraction place;  ///< within 0.15 m of the true stretch's middle, where it has one
    double median_place_error_m = 0.0;
    Shrinkage load_torque;
    Shrinkage clearest_channel;
    std::vector<std::string> unanswered;  ///< cases without an answer; not in any of the numbers
};

/// The gap that the true cause leaves in a case, where that is known.
struct Reference {
    std::string name;
    std::optional<std::vector<ChannelRms>> channels;
};

/// The gap that remains when only the true cause is fitted: in the engine's form of it (the simulation has
/// another form), with the nominal numbers, as a diagnosis fits them. A diagnosis cannot be expected to
/// shrink the gap further. None where the engine does not have the label's effect.
std::optional<std::vector<ChannelRms>> reference_fit(const Recording& recording, const CaseLabel& label);

/// `answers` and `references` in any order; cases of the labels without an answer are listed, not scored.
TrialScore score_trial(const TrialLabels& labels, const std::vector<CaseAnswer>& answers,
                       const std::vector<Reference>& references);

}  // namespace capstan::gap_trial
