// An estimator in a control loop: a call has microseconds, so the common arguments take a short way.

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <span>

#include "arrays.h"
#include "bindings.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/controller/observer.h"
#include "signatures.h"

namespace capstan::python {

namespace {

// What a sample must be before the observer takes it.
void check(const Observer& observer, double time_s, std::span<const double> readings) {
    if (readings.size() != observer.readings())
        throw InvalidInput({fmt::format(
            "readings: there are {}, but must be {}: how much the motor has reeled in [m], then one of each "
            "sensor",
            readings.size(), observer.readings())});
    if (!(time_s > observer.time_s()) || !std::isfinite(time_s))
        throw InvalidInput({fmt::format("time_s: is {:g}, but must be a number above the last, {:g}", time_s,
                                        observer.time_s())});
    for (std::size_t k = 0; k < readings.size(); ++k) {
        if (!std::isfinite(readings[k]))
            throw InvalidInput(
                {fmt::format("readings[{}]: is {:g}, but must be a finite number", k, readings[k])});
    }
}

void checked_update(Observer& observer, double time_s, std::span<const double> readings) {
    check(observer, time_s, readings);
    observer.update(time_s, readings);
}

// ("tension", place in m) or ("displacement", "load")
ObserverSensor sensor_of(const py::handle& given, std::size_t k) {
    const std::string name = "sensors[" + std::to_string(k) + "]";
    const bool is_pair =
        py::isinstance<py::sequence>(given) && !py::isinstance<py::str>(given) && py::len(given) == 2;
    const std::string kind = is_pair ? std::string(py::str(given[py::int_(0)])) : std::string();
    if (kind == "displacement" && std::string(py::str(given[py::int_(1)])) == "load") return {true, 0.0};
    if (kind != "tension")
        throw InvalidInput({name + ": is " + std::string(py::repr(given)).substr(0, 80) +
                            ", but must be (\"tension\", place in m) or (\"displacement\", \"load\")"});
    return {false, number_of(given[py::int_(1)], name + "[1]")};
}

// As RateFriction of the package gives it: drag, extra friction, its speed and its memory.
RateFriction rate_friction_of(const py::sequence& given) {
    const auto number = [&](py::size_t k, const char* name) {
        return number_of(given[k], std::string("rate_friction.") + name);
    };
    return {{number(0, "drag_N_s_per_m2")},
            {number(1, "extra_friction"), number(2, "speed_m_per_s"), number(3, "memory_s")}};
}

std::unique_ptr<Observer> make_observer(const PythonCable& held, const Sensors& sensors_given,
                                        const Number& noise_N, const Number& load_wander_m,
                                        const Number& motor_wander_m, const Integer& members,
                                        const Integer& seed, const FourNumbers& rate_friction) {
    std::vector<ObserverSensor> sensors;
    const py::sequence given = sensors_given;
    for (std::size_t k = 0; k < given.size(); ++k) sensors.push_back(sensor_of(given[k], k));
    const ObserverSettings settings{
        .noise_N = number_of(noise_N, "noise_N"),
        .load_wander_m = number_of(load_wander_m, "load_wander_m"),
        .motor_wander_m = number_of(motor_wander_m, "motor_wander_m"),
        .members = static_cast<int>(integer_of(members, "members")),
        .seed = static_cast<std::uint64_t>(integer_of(seed, "seed", {0, 9200000000000000000})),
        .rate_friction = rate_friction_of(rate_friction)};
    return std::make_unique<Observer>(held.cable, std::move(sensors), settings);
}

// A list or tuple of floats, and an array of them, need no conversion by NumPy.
bool take_plainly(const py::handle& given, std::span<double> readings) {
    if (PyList_CheckExact(given.ptr()) || PyTuple_CheckExact(given.ptr())) {
        if (static_cast<std::size_t>(PySequence_Fast_GET_SIZE(given.ptr())) != readings.size()) return false;
        PyObject** items = PySequence_Fast_ITEMS(given.ptr());
        for (std::size_t k = 0; k < readings.size(); ++k) {
            if (!PyFloat_CheckExact(items[k])) return false;
            readings[k] = PyFloat_AS_DOUBLE(items[k]);
        }
        return true;
    }
    static const PyObject* const plain_array =
        py::object(py::module_::import("numpy").attr("ndarray")).release().ptr();
    if (reinterpret_cast<PyObject*>(Py_TYPE(given.ptr())) != plain_array ||
        !py::isinstance<py::array_t<double, py::array::c_style>>(given))
        return false;
    const auto array = py::reinterpret_borrow<py::array_t<double, py::array::c_style>>(given);
    if (array.ndim() != 1 || static_cast<std::size_t>(array.size()) != readings.size()) return false;
    std::copy(array.data(), array.data() + readings.size(), readings.begin());
    return true;
}

using Row = py::array_t<double>;

std::tuple<Row, Row, Row> update(Observer& observer, const Number& time_s, const Numbers& given) {
    constexpr std::size_t few = 16;
    double plain[few];
    const double at_s =
        PyFloat_CheckExact(time_s.ptr()) ? PyFloat_AS_DOUBLE(time_s.ptr()) : number_of(time_s, "time_s");
    const std::span<double> readings(plain, std::min(few, observer.readings()));
    if (observer.readings() <= few && take_plainly(given, readings))
        checked_update(observer, at_s, readings);
    else
        checked_update(observer, at_s, numbers_of(given, "readings"));
    const py::ssize_t nodes = observer.nodes();
    auto memory = py::array_t<double>({py::ssize_t{3}, nodes});
    double* estimate_N = memory.mutable_data();
    const auto count = static_cast<std::size_t>(nodes);
    observer.write_estimate({estimate_N, count}, {estimate_N + count, count},
                            {estimate_N + 2 * count, count});
    const auto row = [&](py::ssize_t k) {
        return py::reinterpret_steal<Row>(PySequence_GetItem(memory.ptr(), k));
    };
    return {row(0), row(1), row(2)};
}

}  // namespace

void bind_observers(py::module_& module) {
    using namespace py::literals;
    py::class_<Observer>(module, "Observer")
        .def(py::init(&make_observer), "cable"_a, "sensors"_a, "noise_N"_a, "load_wander_m"_a,
             "motor_wander_m"_a, "members"_a, "seed"_a, "rate_friction"_a)
        .def(
            "update", &update, "time_s"_a, "readings"_a,
            "The mean and the limits of the 95% band at every node [N], after one more sample. `readings`: how much "
            "cable the motor has reeled in [m], then one of each sensor [N or m].")
        .def_property_readonly("slack_members", [](const Observer& o) { return o.report().slack; })
        .def_property_readonly("unverified_members", [](const Observer& o) { return o.report().unverified; });
}

}  // namespace capstan::python
