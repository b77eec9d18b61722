#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <memory>

#include "arrays.h"
#include "bindings.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/bench_model/model_file.h"
#include "capstan/bench_model/model_prediction.h"
#include "capstan/cable/conduit.h"
#include "capstan/estimate/observed_cable.h"
#include "capstan/reports/page_frame.h"
#include "long_call.h"
#include "signatures.h"

namespace capstan::python {

namespace {

using bench_model::BenchModel;

struct PythonPrediction {
    BenchModel model;
    Recording recording;
    bench_model::ModelPrediction prediction;
};

BenchModel model_of(const PythonDiagnosis& found) {
    const py::gil_scoped_release others_run;
    const auto& split = found.runs.split;
    const bench_model::ModelOrigin origin{split.recorded.name, split.split.fit, reports::program_version(),
                                          answers::verdict_sentence(split.diagnosis)};
    return bench_model::model_of(split, found.runs.left_over, origin, {});
}

using BendNumbers = std::tuple<double, double, double>;  // angle in degrees, radius, place
// Length, bends, stiffness, both frictions and pretension.
using CableNumbers = std::tuple<double, std::vector<BendNumbers>, double, double, double, double>;
using FrictionNumbers =
    std::tuple<double, double, double, double>;  // drag; extra friction, speed, memory (E20, E21)

// A cable of the model, its friction that depends on the speed, and what an observer of it leaves out.
std::tuple<CableNumbers, FrictionNumbers, std::vector<std::string>> observed_cable(
    const BenchModel& model, const std::string& name, const OptionalNumber& pretension_N,
    const Number& session_s, const std::map<std::string, double>& conditions, bool speed_dependent) {
    if (name != "A" && name != "B")
        throw InvalidInput({fmt::format("cable: is '{}', but must be 'A' or 'B'", name)});
    const estimate::ObservedCable cable = estimate::observed_cable(
        model, {.cable = name == "A" ? BentCables::only_a : BentCables::only_b,
                .pretension_N = pretension_N.is_none() ? model.description.pretension_N
                                                       : number_of(pretension_N, "pretension_N"),
                .session_s = number_of(session_s, "session_s"),
                .conditions = conditions,
                .speed_dependent = speed_dependent});
    const CableSpecification& made = cable.specification;
    std::vector<BendNumbers> bends;
    double at_m = 0.0;
    for (const CurvaturePiece& piece : made.curvature) {
        if (piece.bend_radius_m != straight)
            bends.emplace_back(piece.length_m / piece.bend_radius_m / rad_per_degree, piece.bend_radius_m,
                               at_m);
        at_m += piece.length_m;
    }
    const Stribeck& stribeck = cable.rate_friction.stribeck;
    return {CableNumbers(at_m, bends, made.axial_stiffness_N, made.dynamic_friction, made.static_friction,
                         made.pretension_N),
            FrictionNumbers(cable.rate_friction.viscous.drag_N_s_per_m2, stribeck.extra_friction,
                            stribeck.speed_m_per_s, stribeck.memory_s),
            cable.not_used};
}

std::shared_ptr<PythonPrediction> predict(const BenchModel& model,
                                          const std::shared_ptr<PythonRecording>& held,
                                          const std::vector<int>& runs, const Integer& jobs) {
    auto predicted = std::make_shared<PythonPrediction>();
    const int threads = jobs_of(jobs);
    run_long_call(py::none(), [=](CallWatch&) {
        predicted->model = model;
        predicted->recording =
            runs.empty() ? held->recording : model_comparison::runs_of(held->recording, runs);
        predicted->prediction = bench_model::predict(model, predicted->recording, threads);
    });
    return predicted;
}

std::shared_ptr<reports::Answer> prediction_answer(const PythonPrediction& predicted) {
    const py::gil_scoped_release others_run;
    return std::make_shared<reports::Answer>(
        answers::model_answer(predicted.recording, predicted.model, predicted.prediction));
}

// None where the model says nothing of the channel in this run.
std::optional<py::array_t<double>> predicted_samples(const py::object& self, int number,
                                                     const std::string& channel, const std::string& of) {
    const auto& held = self.cast<const PythonPrediction&>();
    const auto index = held.recording.channel(channel);
    if (!index) throw InvalidInput({held.recording.name + ": there is no channel '" + channel + "'"});
    const model_comparison::Predictions& values = of == "nominal"    ? held.prediction.nominal
                                                  : of == "with_law" ? held.prediction.with_law
                                                                     : held.prediction.model;
    for (std::size_t run = 0; run < held.recording.runs.size(); ++run) {
        if (held.recording.runs[run].number != number) continue;
        const std::vector<double>& samples = values.values[run][static_cast<std::size_t>(*index)];
        if (samples.empty()) return {};
        return view_of(samples, self);
    }
    throw InvalidInput({held.recording.name + ": there is no run " + std::to_string(number)});
}

}  // namespace

void bind_models(py::module_& module) {
    using namespace py::literals;
    py::class_<PythonPrediction, std::shared_ptr<PythonPrediction>>(module, "Prediction")
        .def("answer", &prediction_answer)
        .def("samples", &predicted_samples, "run"_a, "channel"_a, "of"_a);
    py::class_<BenchModel>(module, "Model")
        .def("text", &bench_model::model_text)
        .def(
            "save",
            [](const BenchModel& model, const std::filesystem::path& file) {
                bench_model::write_model(file, model);
            },
            "file"_a)
        .def("observed_cable", &observed_cable, "name"_a, "pretension_N"_a, "session_s"_a, "conditions"_a,
             "speed_dependent"_a)
        .def_property_readonly("tension_noise_N",
                               [](const BenchModel& model) { return model.tension_noise_N; })
        .def("predict", &predict, "recording"_a, "runs"_a, "jobs"_a);
    module.def("model_of", &model_of, "diagnosis"_a);
    module.def("read_model", &bench_model::read_model, "file"_a);
}

}  // namespace capstan::python
