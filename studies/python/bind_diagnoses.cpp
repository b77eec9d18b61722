#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>

#include "arrays.h"
#include "bindings.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/storage/diagnosis_store.h"
#include "long_call.h"
#include "signatures.h"

namespace capstan::python {

namespace {

std::shared_ptr<PythonDiagnosis> diagnose(const std::shared_ptr<PythonRecording>& held,
                                          const std::vector<int>& runs, const std::vector<int>& calibrate_on,
                                          const std::vector<int>& fit, const std::vector<int>& hold,
                                          bool with_simple_models, const OptionalNumber& time_limit_s,
                                          const Integer& jobs, const Progress& on_progress) {
    gap::DiagnosisOptions options;
    options.threads = jobs_of(jobs);
    if (!time_limit_s.is_none()) options.time_limit_s = number_of(time_limit_s, "time_limit_s");
    if (!(options.time_limit_s > 0.0)) throw InvalidInput({"time_limit_s: must be above 0"});
    const model_comparison::DiagnosisRequest request{runs, calibrate_on, fit, hold, with_simple_models};
    auto found = std::make_shared<PythonDiagnosis>();
    run_long_call(on_progress, [=](CallWatch& watch) mutable {
        options.on_progress = [&](const std::string& activity, double fraction) {
            watch.tell(activity, fraction);
        };
        found->runs = model_comparison::diagnose_runs(held->recording, request, options);
    });
    return found;
}

std::shared_ptr<reports::Answer> answer_of(const PythonDiagnosis& found) {
    const py::gil_scoped_release others_run;
    return std::make_shared<reports::Answer>(answers::diagnosed_runs_answer(found.runs));
}

std::string corrected_model(const PythonDiagnosis& found) {
    return answers::corrected_model_text(found.runs.split.diagnosed, found.runs.split.diagnosis);
}

std::int64_t store(const PythonDiagnosis& found, const std::filesystem::path& database,
                   const std::filesystem::path& log) {
    const py::gil_scoped_release others_run;
    storage::Database opened = storage::Database::open_or_create(database);
    const auto& split = found.runs.split;
    return storage::write_diagnosis(opened, answers::diagnosis_record(split.diagnosed, split.diagnosis, log));
}

}  // namespace

void bind_diagnoses(py::module_& module) {
    using namespace py::literals;
    py::class_<PythonDiagnosis, std::shared_ptr<PythonDiagnosis>>(module, "Diagnosis")
        .def("answer", &answer_of)
        .def("corrected_model", &corrected_model)
        .def("store", &store, "db"_a, "log"_a);
    module.def("diagnose", &diagnose, "recording"_a, "runs"_a, "calibrate_on"_a, "fit"_a, "hold"_a,
               "baselines"_a, "time_limit_s"_a, "jobs"_a, "on_progress"_a);
}

}  // namespace capstan::python
