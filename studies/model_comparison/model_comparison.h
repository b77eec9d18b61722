#pragma once

#include <string>
#include <vector>

#include "capstan/gap/diagnosis.h"
#include "capstan/gap/equivalent_bench.h"
#include "capstan/model_comparison/left_over.h"

namespace capstan::model_comparison {

/// Numbers of the runs that models are fitted to, and of those that they are judged on.
struct RunSplit {
    std::vector<int> fit;
    std::vector<int> hold;
};

/// Every other run is fitted and the rest judged, then the other way round. Of a single run nothing is held
/// out.
std::vector<RunSplit> alternating_splits(const Recording& recording);

/// The runs with these numbers, in this order. Throws InvalidInput where a run is missing.
Recording runs_of(const Recording& recording, const std::vector<int>& numbers);

/// The bench of a split, and the diagnosis of its fitted runs, which saw no other run.
struct DiagnosedSplit {
    RunSplit split;
    Recording recorded;   ///< all runs of the split, the fitted ones first
    Recording bench;      ///< the same, as the equivalent bench calibrated to the fitted runs
    Recording diagnosed;  ///< the fitted runs of `bench`
    gap::Diagnosis diagnosis;
    std::optional<gap::BenchEquivalence> equivalence{};  ///< none where the geometry is known
};

/// All of a split but its diagnosis. `calibrate_on` as in diagnose_split.
DiagnosedSplit prepared_split(const Recording& recording, const RunSplit& split,
                              const std::vector<int>& calibrate_on = {});

/// `calibrate_on`: runs to which a bench of unknown geometry is calibrated; empty: the fitted ones.
DiagnosedSplit diagnose_split(const Recording& recording, const RunSplit& split,
                              const gap::DiagnosisOptions& options,
                              const std::vector<int>& calibrate_on = {});

struct RunError {
    int run = 0;
    double rms = 0.0;  ///< from one second into the run, in the channel's unit
};

/// RMS over runs that count alike; none without a run.
std::optional<double> rms_over_runs(const std::vector<RunError>& errors);

struct ModelErrors {
    std::string name;     ///< in JSON
    std::string title;    ///< for people
    std::string heading;  ///< the same in a word
    std::string formula;  ///< in words
    std::vector<RunError> fitted;
    std::vector<RunError> held_out;
};

struct OutputComparison {
    std::string channel;
    std::string unit;
    std::vector<ModelErrors> models;  ///< the simple ones, then the bench's
};

struct ModelComparison {
    std::vector<RunSplit> splits;
    std::vector<OutputComparison> outputs;
};

enum class Compared { bench_alone, with_simple_models };

/// Adds the errors of the bench's model (nominal or calibrated, corrected, corrected with the law of what is
/// left) and of every simple model in one split. All are fitted to the same runs.
void add_split(ModelComparison& comparison, const DiagnosedSplit& split, Compared compared,
               const gap::DiagnosisOptions& options);

}  // namespace capstan::model_comparison
