// An estimator in a control loop: a call has microseconds, so the common arguments take a short way.

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <span>

#include "arrays.h"
#include "bindings.h"
#include "capstan/cable/cable_state.h"
#include "capstan/ensemble/far_end_process.h"
#include "capstan/estimation/recursive_estimator.h"

namespace capstan::python {

namespace {

struct ObserverSettings {
    double noise_N = 0.0;
    RecursiveSettings recursive;
};

// What a reading after the motor's is.
struct SensorRole {
    bool is_load_displacement = false;
    SensorSpot spot{};
};

class Observer {
  public:
    Observer(const Cable& cable, std::vector<SensorRole> sensors, const ObserverSettings& settings)
        : step_(cable, ModelRules::consistent()),
          start_(pretensioned(step_.cable())),
          estimator_(step_, start_, settings.recursive),
          sensors_(std::move(sensors)) {
        for (const SensorRole& sensor : sensors_) {
            if (!sensor.is_load_displacement)
                tensions_.push_back({sensor.spot, 0.0, {.additive_N = settings.noise_N}});
        }
    }

    std::size_t readings() const { return 1 + sensors_.size(); }
    int nodes() const { return step_.cable().nodes(); }

    void update(double time_s, std::span<const double> readings) {
        check(time_s, readings);
        KnownEnds ends{start_.displacement_m.front() - readings[0], load_m_};
        std::size_t tension = 0;
        for (std::size_t k = 0; k < sensors_.size(); ++k) {
            if (sensors_[k].is_load_displacement)
                ends.distal_displacement_m = readings[k + 1];
            else
                tensions_[tension++].value_N = readings[k + 1];
        }
        report_ = estimator_.step(ends, tensions_);
        load_m_ = ends.distal_displacement_m;
        time_s_ = time_s;
    }

    // 3 x nodes: mean, and the limits of the 95% band.
    void write(double* estimate) const {
        const auto count = static_cast<std::size_t>(nodes());
        for (std::size_t node = 0; node < count; ++node) {
            const double half_N = deviations_of_95 * estimator_.deviation_N()[node];
            estimate[node] = estimator_.mean_N()[node];
            estimate[count + node] = estimate[node] - half_N;
            estimate[2 * count + node] = estimate[node] + half_N;
        }
    }

    const RecursiveReport& report() const { return report_; }

  private:
    void check(double time_s, std::span<const double> readings) const {
        if (readings.size() != sensors_.size() + 1)
            throw InvalidInput({fmt::format(
                "readings: there are {}, but must be {}: how much the motor has reeled in [m], then one of each "
                "sensor",
                readings.size(), sensors_.size() + 1)});
        if (!(time_s > time_s_) || !std::isfinite(time_s))
            throw InvalidInput(
                {fmt::format("time_s: is {:g}, but must be a number above the last, {:g}", time_s, time_s_)});
        for (std::size_t k = 0; k < readings.size(); ++k) {
            if (!std::isfinite(readings[k]))
                throw InvalidInput(
                    {fmt::format("readings[{}]: is {:g}, but must be a finite number", k, readings[k])});
        }
    }

    QuasiStaticStep step_;
    CableState start_;
    RecursiveEstimator estimator_;
    std::vector<SensorRole> sensors_;
    std::vector<TensionReading> tensions_;
    RecursiveReport report_;
    double load_m_ = 0.0;
    double time_s_ = -std::numeric_limits<double>::infinity();
};

// ("tension", place in m) or ("displacement", "load")
SensorRole role_of(const Cable& cable, const py::handle& given, std::size_t k) {
    const std::string name = "sensors[" + std::to_string(k) + "]";
    const bool is_pair =
        py::isinstance<py::sequence>(given) && !py::isinstance<py::str>(given) && py::len(given) == 2;
    const std::string kind = is_pair ? std::string(py::str(given[py::int_(0)])) : std::string();
    if (kind == "displacement" && std::string(py::str(given[py::int_(1)])) == "load") return {true, {}};
    if (kind != "tension")
        throw InvalidInput({name + ": is " + std::string(py::repr(given)).substr(0, 80) +
                            ", but must be (\"tension\", place in m) or (\"displacement\", \"load\")"});
    const double place_m = number_of(given[py::int_(1)], name + "[1]");
    if (!(place_m >= 0.0 && place_m <= cable.length_m()))
        throw InvalidInput({fmt::format("{}[1]: is {:g} m, but the cable reaches from 0 to {:g} m", name,
                                        place_m, cable.length_m())});
    return {false, spot_at(cable, place_m)};
}

std::unique_ptr<Observer> make_observer(const PythonCable& held, const py::sequence& sensors,
                                        const py::handle& noise_N, const py::handle& load_wander_m,
                                        const py::handle& motor_wander_m, const py::handle& members,
                                        const py::handle& seed) {
    std::vector<SensorRole> roles;
    bool load_is_measured = false;
    for (std::size_t k = 0; k < sensors.size(); ++k) {
        roles.push_back(role_of(held.cable, sensors[k], k));
        if (roles.back().is_load_displacement && load_is_measured)
            throw InvalidInput({"sensors: two measure the displacement of the load; give one"});
        load_is_measured |= roles.back().is_load_displacement;
    }
    ObserverSettings settings;
    settings.noise_N = number_of(noise_N, "noise_N");
    if (!(settings.noise_N > 0.0) || !std::isfinite(settings.noise_N))
        throw InvalidInput({fmt::format("noise_N: is {:g}, but must be above 0", settings.noise_N)});
    settings.recursive.wander = {number_of(motor_wander_m, "motor_wander_m"),
                                 number_of(load_wander_m, "load_wander_m")};
    settings.recursive.members = static_cast<int>(integer_of(members, "members"));
    settings.recursive.seed = static_cast<std::uint64_t>(integer_of(seed, "seed", {0, 9200000000000000000}));
    return std::make_unique<Observer>(held.cable, std::move(roles), settings);
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

py::tuple update(Observer& observer, const py::handle& time_s, const py::handle& given) {
    constexpr std::size_t few = 16;
    double plain[few];
    const double at_s =
        PyFloat_CheckExact(time_s.ptr()) ? PyFloat_AS_DOUBLE(time_s.ptr()) : number_of(time_s, "time_s");
    const std::span<double> readings(plain, std::min(few, observer.readings()));
    if (observer.readings() <= few && take_plainly(given, readings))
        observer.update(at_s, readings);
    else
        observer.update(at_s, numbers_of(given, "readings"));
    const py::ssize_t nodes = observer.nodes();
    auto memory = py::array_t<double>({py::ssize_t{3}, nodes});
    observer.write(memory.mutable_data());
    PyObject* rows = PyTuple_New(3);
    for (py::ssize_t k = 0; k < 3; ++k) PyTuple_SET_ITEM(rows, k, PySequence_GetItem(memory.ptr(), k));
    return py::reinterpret_steal<py::tuple>(rows);
}

}  // namespace

void bind_observers(py::module_& module) {
    py::class_<Observer>(module, "Observer")
        .def(py::init(&make_observer))
        .def(
            "update", &update, py::arg("time_s"), py::arg("readings"),
            "The mean and the limits of the 95% band at every node [N], after one more sample. `readings`: how much "
            "cable the motor has reeled in [m], then one of each sensor [N or m].")
        .def_property_readonly("slack_members", [](const Observer& o) { return o.report().slack; })
        .def_property_readonly("unverified_members", [](const Observer& o) { return o.report().unverified; });
}

}  // namespace capstan::python
