#include <pybind11/stl.h>

#include <algorithm>

#include "arrays.h"
#include "bindings.h"
#include "capstan/cable/conduit.h"
#include "capstan/cable_paths/cable_paths.h"
#include "long_call.h"
#include "signatures.h"

namespace capstan::python {

namespace {

// Below so many node updates a call takes a few milliseconds: no longer than Ctrl-C may wait, and a thread of
// its own would cost more than it brings.
constexpr std::size_t few_node_updates = 100000;

std::vector<Bend> bends_of(const py::sequence& given) {
    std::vector<Bend> bends;
    for (std::size_t k = 0; k < given.size(); ++k) {
        const py::tuple each = given[k];
        const std::string bend = "bends[" + std::to_string(k) + "].";
        bends.push_back({number_of(each[0], bend + "angle_deg") * rad_per_degree,
                         number_of(each[1], bend + "radius_m"), number_of(each[2], bend + "at_m")});
    }
    return bends;
}

PythonCable make_cable(const Number& length_m, const Bends& bends, const Number& axial_stiffness_N,
                       const Number& friction, const OptionalNumber& static_friction,
                       const Number& pretension_N, const Integer& segments) {
    CableSpecification cable;
    cable.curvature = pieces_of(bends_of(bends), number_of(length_m, "length_m"));
    cable.segments = static_cast<int>(integer_of(segments, "segments", {1, 100000}));
    cable.axial_stiffness_N = number_of(axial_stiffness_N, "axial_stiffness_N");
    cable.dynamic_friction = number_of(friction, "friction");
    cable.static_friction =
        static_friction.is_none() ? cable.dynamic_friction : number_of(static_friction, "static_friction");
    cable.pretension_N = number_of(pretension_N, "pretension_N");
    return {Cable(cable)};
}

CableLoad load_of(const std::string& kind, const py::handle& number) {
    if (kind == "spring") return SpringLoad{number_of(number, "load.stiffness_N_per_m")};
    if (kind == "weight") return WeightLoad{number_of(number, "load.tension_N")};
    if (kind == "moved") return MovedLoad{numbers_of(number, "load.displacement_m")};
    return BlockedLoad{};
}

// One number stands for all draws.
CableDraws draws_alike(CableDraws draws) {
    const auto lists = {&draws.friction, &draws.axial_stiffness_N, &draws.pretension_N};
    std::size_t count = 1;
    for (const auto* list : lists) count = std::max(count, list->size());
    for (auto* list : lists)
        if (list->size() == 1) list->assign(count, list->front());
    return draws;
}

// Tension and displacement, and the number of steps that passed no check.
std::tuple<py::array_t<double>, py::array_t<double>, std::int64_t> simulate(
    const PythonCable& held, const Numbers& motor_m, const std::string& load_kind,
    const OptionalNumbers& load_number, const OptionalNumbers& friction,
    const OptionalNumbers& axial_stiffness_N, const OptionalNumbers& pretension_N, const Integer& jobs) {
    struct Work {
        Cable cable;
        CableMotion motion;
        CableDraws draws;
        int jobs;
        ArrayMemory tension_N, displacement_m;
        PathReport report{};

        void run() {
            report = simulate_paths(cable, motion, draws, jobs,
                                    {{tension_N.numbers.get(), tension_N.size()},
                                     {displacement_m.numbers.get(), displacement_m.size()}});
        }
    };
    CableMotion motion{numbers_of(motor_m, "motor_m"), load_of(load_kind, load_number)};
    CableDraws draws =
        draws_alike({draws_of(friction, "friction"), draws_of(axial_stiffness_N, "axial_stiffness_N"),
                     draws_of(pretension_N, "pretension_N")});
    if (const auto problems = problems_of(held.cable, motion, draws); !problems.empty())
        throw InvalidInput(problems);  // before there is memory for the paths
    const std::vector<py::ssize_t> shape = {count_of(draws), static_cast<py::ssize_t>(motion.motor_m.size()),
                                            held.cable.nodes()};
    const auto work = std::make_shared<Work>(Work{held.cable, std::move(motion), std::move(draws),
                                                  jobs_of(jobs), ArrayMemory(shape), ArrayMemory(shape)});
    if (work->tension_N.size() < few_node_updates) {
        const py::gil_scoped_release others_run;
        work->run();
    } else {
        run_long_call(py::none(), [work](CallWatch&) { work->run(); });
    }
    return {array_of(std::move(work->tension_N)), array_of(std::move(work->displacement_m)),
            work->report.unverified};
}

py::array_t<double> places_m(const Cable& cable) {
    ArrayMemory places({cable.nodes()});
    for (int node = 0; node < cable.nodes(); ++node)
        places.numbers[static_cast<std::size_t>(node)] = cable.node_position_m(node);
    return array_of(std::move(places));
}

}  // namespace

void bind_cables(py::module_& module) {
    using namespace py::literals;
    py::class_<PythonCable>(module, "Cable")
        .def(py::init(&make_cable), "length_m"_a, "bends"_a, "axial_stiffness_N"_a, "friction"_a,
             "static_friction"_a, "pretension_N"_a, "segments"_a)
        .def_property_readonly("length_m", [](const PythonCable& held) { return held.cable.length_m(); })
        .def_property_readonly("segments", [](const PythonCable& held) { return held.cable.segments(); })
        .def_property_readonly("places_m", [](const PythonCable& held) { return places_m(held.cable); })
        .def("simulate", &simulate, "motor_m"_a, "load_kind"_a, "load_number"_a, "friction"_a,
             "axial_stiffness_N"_a, "pretension_N"_a, "jobs"_a);
}

}  // namespace capstan::python
