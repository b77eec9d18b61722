#pragma once
// Answers to: what does a recording say of its bench?

#include <filesystem>
#include <string>
#include <vector>

#include "capstan/bench_model/model_prediction.h"
#include "capstan/blind_trial/trial_score.h"
#include "capstan/calibration/calibration.h"
#include "capstan/calibration/twin.h"
#include "capstan/duty/duty_cycle.h"
#include "capstan/estimate/left_out.h"
#include "capstan/gap/diagnosis.h"
#include "capstan/import/column_list.h"
#include "capstan/import/importer.h"
#include "capstan/model_comparison/diagnosed_runs.h"
#include "capstan/model_comparison/diagnosis_cost.h"
#include "capstan/recording/recording.h"
#include "capstan/reports/answer.h"
#include "capstan/storage/diagnosis_records.h"

namespace capstan::answers {

/// "sensor offset (motor torque)"; `variant`: empty if there is none.
std::string cause_words(const std::string& effect, const std::string& variant);
/// "load torque [N m]", as figures name a channel.
std::string drawn_name(const Channel& channel);
/// A column of names that people read in words, and programs as they are: "load torque", `load_torque`.
reports::Column worded_column(const std::string& path);

/// The verdict of a diagnosis in one sentence.
std::string verdict_sentence(const gap::Diagnosis& diagnosis);

/// A diagnosis as the database keeps it; `log`: the file that was diagnosed, whose hash is kept.
storage::DiagnosisRecord diagnosis_record(const Recording& recording, const gap::Diagnosis& diagnosis,
                                          const std::filesystem::path& log = {});

/// What a model keeps of its diagnosis: the numbers, the causes and their probabilities.
storage::DiagnosisRecord diagnosis_record(const bench_model::BenchModel& model);

/// A diagnosis from what the database keeps of it. The samples are not kept, so that it has no curves.
reports::Answer stored_diagnosis_answer(const storage::DiagnosisRecord& diagnosis);

/// A diagnosis with the curves of the recording and the experiment that would decide what it left open.
reports::Answer diagnosis_answer(const Recording& recording, const gap::Diagnosis& diagnosis);

/// Adds a section to a diagnosis before its curves, of which there are many.
void add_before_curves(reports::Answer& answer, reports::AnswerSection section);

/// Adds to a diagnosis what its corrected model leaves of each channel, and what that looks like.
void add_left_over(reports::Answer& answer, const std::vector<model_comparison::LeftOver>& left,
                   const Recording& recording);

/// Adds to a diagnosis the errors of its model, and of simple models, on the runs that each was fitted to and
/// on runs held out.
void add_comparison(reports::Answer& answer, const model_comparison::ModelComparison& comparison);

/// All of that: the answer of `capstan diagnose`.
reports::Answer diagnosed_runs_answer(const model_comparison::DiagnosedRuns& diagnosed);

/// The answer of `capstan diagnose --cost`; `recording`: its name.
reports::Answer diagnosis_cost_answer(const std::string& recording,
                                      const model_comparison::DiagnosisCost& cost);

/// The cable as a diagnosis corrects it, as a file for `capstan study run CONFIG --truth FILE`.
std::string corrected_model_text(const Recording& recording, const gap::Diagnosis& diagnosis);

/// A part of a gap's map as its figure names it, "regime: rest".
std::string part_name(const std::string& divided_by, const std::string& part);

/// Measured channels, the model without and with the cause, residuals, loops, and the parts of the gap's map
/// that the drawn samples belong to.
std::vector<reports::Table> diagnosis_curves(const Recording& recording, const gap::Diagnosis& diagnosis);

reports::Answer calibration_answer(const Recording& recording, const gap::Calibration& calibration);

/// Adds what a model says of the parameters beside what was fitted.
void add_model_of_calibration(reports::Answer& answer, const bench_model::BenchModel& model);

/// How often the drive was in each motion regime.
reports::Answer duty_answer(const Recording& recording, const duty::DutyCycle& duty);

/// Whether the curves of an answer are computed: only its page shows them.
enum class Figures { none, drawn };

/// The channels of one cable that were predicted without themselves.
struct LeftOutCable {
    const estimate::SensedCable* cable = nullptr;
    std::vector<estimate::LeftOutChannel> channels;
};
reports::Answer left_out_answer(const Recording& recording, const std::vector<LeftOutCable>& results,
                                const estimate::TrackingOptions& options, Figures figures);

/// The tension estimated from all channels together, one estimate for each cable.
reports::Answer estimate_answer(const Recording& recording, const std::vector<estimate::SensedCable>& cables,
                                const std::vector<estimate::EstimatorTuning>& estimates,
                                const estimate::TrackingOptions& options, Figures figures);

/// What of a model an estimate used; `not_used`: what it could not.
std::string model_use_sentence(const bench_model::BenchModel& model,
                               const std::vector<std::string>& not_used);
/// Adds that to an estimate.
void add_model_of_estimate(reports::Answer& answer, const bench_model::BenchModel& model,
                           const std::vector<std::string>& not_used);

/// A recording beside its model; `modelled`: one for each run.
reports::Answer recording_answer(const Recording& recording, const std::vector<gap::TwinRun>& modelled);

/// A recording beside what a model of its bench predicts, with the errors of both.
reports::Answer model_answer(const Recording& recording, const bench_model::BenchModel& model,
                             const bench_model::ModelPrediction& prediction);

/// How a blind trial of the diagnosis ended.
reports::Answer trial_score_answer(const gap_trial::TrialOptions& options, const std::string& seal,
                                   const gap_trial::TrialScore& score);

/// The runs of a recording, for a page that draws figures for each run.
reports::Table run_table(const Recording& recording);

/// What an import read, repaired and doubts; its page draws the channels.
reports::Answer import_answer(const imports::ImportReport& report);

/// The columns of logs; for programs also a few numbers of each, for drawing them.
reports::Answer column_list_answer(const imports::ColumnList& list);

/// What was taken for what a recording's sidecar leaves out. The recording has such assumptions.
reports::AnswerSection assumptions_section(const Recording& recording);

/// Whether a recording can be used: every problem, or what was taken for what its sidecar leaves out.
reports::Answer recording_check_answer(const Recording& recording, const std::vector<std::string>& problems);

/// The table of keys of a recording's sidecar, its channels and the kinds of bench.
reports::Answer recording_keys_answer();

}  // namespace capstan::answers
