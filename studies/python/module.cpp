// capstan._core: the library's functions as Python calls them. The package capstan gives them their keyword
// arguments, defaults and documentation.

#include <stdexcept>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/reports/page_frame.h"
#include "long_call.h"

namespace capstan::python {

namespace {

void raise_error(const std::vector<std::string>& problems) {
    py::list listed;
    for (const std::string& problem : problems)
        listed.append(py::reinterpret_steal<py::str>(
            PyUnicode_DecodeUTF8(problem.data(), static_cast<py::ssize_t>(problem.size()), "replace")));
    const py::object error = py::module_::import("capstan.errors").attr("Error");
    PyErr_SetObject(error.ptr(), error(listed).ptr());
}

}  // namespace

void bind_errors(py::module_&) {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            std::rethrow_exception(std::move(thrown));
        } catch (const InvalidInput& error) {
            raise_error(error.problems());
        } catch (const py::builtin_exception&) {
            throw;
        } catch (const std::runtime_error& error) {  // storage, files
            raise_error({error.what()});
        }
    });
}

}  // namespace capstan::python

PYBIND11_MODULE(_core, module) {
    using namespace capstan::python;
    bind_errors(module);
    bind_answers(module);
    bind_cables(module);
    bind_recordings(module);
    bind_diagnoses(module);
    bind_models(module);
    bind_studies(module);
    bind_observers(module);
    module.attr("version") = capstan::reports::program_version();
    module.def("wait_for_interrupted_calls", &wait_for_interrupted_calls);
}
