#include <pybind11/stl.h>

#include "bindings.h"
#include "capstan/reports/answer.h"

namespace capstan::python {

namespace {

// A format is written without the GIL: a page of a long recording takes a second.
std::string text_in(const reports::Answer& answer, reports::AnswerFormat format) {
    const py::gil_scoped_release others_run;
    return reports::answer_in(answer, format);
}

}  // namespace

void bind_answers(py::module_& module) {
    using reports::Answer;
    using reports::AnswerFormat;
    py::class_<Answer, std::shared_ptr<Answer>>(module, "Answer")
        .def_readonly("kind", &Answer::kind)
        .def_readonly("title", &Answer::title)
        .def_readonly("headline", &Answer::headline)
        .def("text", [](const Answer& answer) { return text_in(answer, AnswerFormat::text); })
        .def("json", [](const Answer& answer) { return text_in(answer, AnswerFormat::json); })
        .def("csv", [](const Answer& answer) { return text_in(answer, AnswerFormat::csv); })
        .def("markdown", [](const Answer& answer) { return text_in(answer, AnswerFormat::markdown); })
        .def("html", [](const Answer& answer) { return text_in(answer, AnswerFormat::html); });
}

}  // namespace capstan::python
