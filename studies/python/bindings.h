#pragma once

#include <pybind11/pybind11.h>

#include "capstan/cable/cable.h"
#include "capstan/model_comparison/diagnosed_runs.h"

namespace capstan::python {

namespace py = pybind11;

/// What capstan.Cable holds.
struct PythonCable {
    Cable cable;
};

/// What capstan.Recording holds.
struct PythonRecording {
    Recording recording;
};

/// What capstan.Diagnosis holds.
struct PythonDiagnosis {
    model_comparison::DiagnosedRuns runs;
};

// The parts of the module, in the order in which they refer to each other.
void bind_errors(py::module_& module);
void bind_answers(py::module_& module);
void bind_cables(py::module_& module);
void bind_recordings(py::module_& module);
void bind_diagnoses(py::module_& module);
void bind_models(py::module_& module);
void bind_studies(py::module_& module);
void bind_observers(py::module_& module);

}  // namespace capstan::python
