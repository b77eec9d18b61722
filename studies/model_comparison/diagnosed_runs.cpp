#include "capstan/model_comparison/diagnosed_runs.h"

#include <algorithm>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/model_comparison/diagnosis_cost.h"

namespace capstan::model_comparison {

namespace {

bool lists(const std::vector<int>& numbers, int number) {
    return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

std::vector<int> all_but(const std::vector<int>& listed, const Recording& recording) {
    std::vector<int> others;
    for (const RecordedRun& run : recording.runs)
        if (!lists(listed, run.number)) others.push_back(run.number);
    return others;
}

RunSplit asked_split(const DiagnosisRequest& request, const Recording& recording) {
    if (!request.runs.empty() || !request.calibrate_on.empty())
        throw InvalidInput({std::string(request.runs.empty() ? "calibrate-on" : "runs") +
                            " does not go with fit and hold, which choose the runs"});
    for (const int number : request.hold) {
        if (lists(request.fit, number))
            throw InvalidInput({"run " + std::to_string(number) +
                                " is both in fit and in hold; a run is either fitted or held out"});
    }
    RunSplit split{request.fit.empty() ? all_but(request.hold, recording) : request.fit,
                   request.hold.empty() ? all_but(request.fit, recording) : request.hold};
    if (split.fit.empty()) throw InvalidInput({"hold leaves no run to fit"});
    return split;
}

RunSplit split_of(const Recording& recording, const DiagnosisRequest& request) {
    if (request.has_split()) return asked_split(request, recording);
    return {request.runs.empty() ? all_but({}, recording) : request.runs, {}};
}

std::vector<LeftOver> left_over_of(const DiagnosedSplit& split) {
    const Recording fitted = runs_of(split.recorded, split.split.fit);
    return fit_left_over(fitted, in_recorded_channels(fitted, split.diagnosed, split.diagnosis.gap.leading));
}

}  // namespace

DiagnosedSplit prepared_runs(const Recording& recording, const DiagnosisRequest& request) {
    return prepared_split(recording, split_of(recording, request), request.calibrate_on);
}

DiagnosedRuns diagnose_runs(const Recording& recording, const DiagnosisRequest& request,
                            const gap::DiagnosisOptions& options,
                            const std::function<void(const DiagnosisCost&)>& on_cost) {
    const bool compares_halves = request.with_simple_models && !request.has_split();
    const double diagnoses =
        compares_halves ? 1.0 + static_cast<double>(alternating_splits(recording).size()) : 1.0;
    double done = 0.0;
    gap::DiagnosisOptions counted = options;
    counted.on_progress = [&](const std::string& activity, double fraction) {
        options.on_progress(activity, (done + fraction) / diagnoses);
    };
    DiagnosedRuns runs{prepared_runs(recording, request), {}, {}};
    constexpr double pilot_s = 0.1;
    if (on_cost) on_cost(cost_of_prepared(runs.split.diagnosed, request, options, pilot_s));
    runs.split.diagnosis = gap::diagnose(runs.split.diagnosed, counted);
    const Compared compared =
        request.with_simple_models ? Compared::with_simple_models : Compared::bench_alone;
    if (request.has_split()) add_split(runs.comparison, runs.split, compared, options);
    if (compares_halves) {
        for (const RunSplit& half : alternating_splits(runs.split.recorded)) {
            done += 1.0;
            add_split(runs.comparison, diagnose_split(runs.split.recorded, half, counted), compared, options);
        }
    }
    runs.left_over = left_over_of(runs.split);
    return runs;
}

}  // namespace capstan::model_comparison
