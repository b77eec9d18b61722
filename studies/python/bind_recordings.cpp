#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>

#include "arrays.h"
#include "bindings.h"
#include "capstan/import/importer.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"
#include "long_call.h"
#include "signatures.h"

namespace capstan::python {

namespace {

using std::filesystem::path;

std::shared_ptr<PythonRecording> read(const path& file) {
    auto held = std::make_shared<PythonRecording>();
    run_long_call(py::none(), [held, file](CallWatch&) { held->recording = read_recording(file); });
    return held;
}

// Writes the recording, and gives what was repaired and what is doubtful: (words, repaired).
std::vector<std::pair<std::string, bool>> import(const std::vector<path>& logs, const path& mapping,
                                                 const path& name, bool strict, const Progress& on_progress) {
    const auto report = std::make_shared<imports::ImportReport>();
    run_long_call(on_progress, [=](CallWatch& watch) {
        imports::ImportOptions options;
        options.strict = strict;
        options.on_progress = [&](const std::string& activity, double fraction) {
            watch.tell(activity, fraction);
        };
        *report = imports::import_logs(logs, imports::read_mapping(mapping), name, options);
    });
    std::vector<std::pair<std::string, bool>> findings;
    for (const imports::Finding& finding : report->findings)
        findings.emplace_back(finding.words, finding.repaired);
    return findings;
}

const RecordedRun& run_of(const PythonRecording& held, int number) {
    for (const RecordedRun& run : held.recording.runs)
        if (run.number == number) return run;
    throw InvalidInput({held.recording.name + ": there is no run " + std::to_string(number)});
}

Units channels_of(const Recording& recording) {
    py::dict units;
    for (const Channel& channel : recording.channels) units[py::str(channel.name)] = channel.unit;
    return Units(units);
}

py::array_t<double> samples_of(const py::object& self, int number, const std::string& channel) {
    const auto& held = self.cast<const PythonRecording&>();
    const RecordedRun& run = run_of(held, number);
    if (channel == "time_s") return view_of(run.time_s, self);
    const auto index = held.recording.channel(channel);
    if (!index) throw InvalidInput({held.recording.name + ": there is no channel '" + channel + "'"});
    return view_of(run.values[static_cast<std::size_t>(*index)], self);
}

}  // namespace

void bind_recordings(py::module_& module) {
    using namespace py::literals;
    py::class_<PythonRecording, std::shared_ptr<PythonRecording>>(module, "Recording")
        .def(py::init(&read), "file"_a)
        .def_property_readonly("name", [](const PythonRecording& held) { return held.recording.name; })
        .def_property_readonly(
            "kind", [](const PythonRecording& held) { return std::string(mode_name(held.recording.mode)); })
        .def_property_readonly("sample_rate_Hz",
                               [](const PythonRecording& held) { return held.recording.sample_rate_Hz; })
        .def_property_readonly("channels",
                               [](const PythonRecording& held) { return channels_of(held.recording); })
        .def_property_readonly("assumptions",
                               [](const PythonRecording& held) { return held.recording.assumptions; })
        .def_property_readonly("run_numbers",
                               [](const PythonRecording& held) {
                                   std::vector<int> numbers;
                                   for (const RecordedRun& run : held.recording.runs)
                                       numbers.push_back(run.number);
                                   return numbers;
                               })
        .def(
            "conditions",
            [](const PythonRecording& held, int number) { return run_of(held, number).conditions; }, "run"_a)
        .def("samples", &samples_of, "run"_a, "channel"_a);
    module.def("import_logs", &import, "logs"_a, "mapping"_a, "name"_a, "strict"_a, "on_progress"_a);
}

}  // namespace capstan::python
