#pragma once

#include <pybind11/pybind11.h>

// Arguments and results by what they mean to Python: the names stand in the signatures of the module, from
// which its stub is made. An argument is taken as it is, and checked by the functions of arrays.h.

namespace capstan::python {

namespace py = pybind11;

template <typename Meaning>
class Typed : public py::object {
  public:
    PYBIND11_OBJECT(Typed, py::object, is_there)

  private:
    static bool is_there(PyObject* given) { return given != nullptr; }
};

namespace meaning {

struct Number {
    static constexpr auto name = py::detail::const_name("float");
};
struct OptionalNumber {
    static constexpr auto name = py::detail::const_name("Optional[float]");
};
struct Integer {
    static constexpr auto name = py::detail::const_name("int");
};
struct OptionalInteger {
    static constexpr auto name = py::detail::const_name("Optional[int]");
};
struct Numbers {
    static constexpr auto name = py::detail::const_name("numpy.typing.ArrayLike");
};
struct OptionalNumbers {
    static constexpr auto name = py::detail::const_name("Optional[numpy.typing.ArrayLike]");
};
struct Bends {
    static constexpr auto name = py::detail::const_name("Sequence[Tuple[float, float, float]]");
};
struct Sensors {
    static constexpr auto name = py::detail::const_name("Sequence[Tuple[str, Union[float, str]]]");
};
struct FourNumbers {
    static constexpr auto name = py::detail::const_name("Tuple[float, float, float, float]");
};
struct Progress {
    static constexpr auto name = py::detail::const_name("Optional[Callable[[str, float], object]]");
};
struct Units {
    static constexpr auto name = py::detail::const_name("Dict[str, str]");
};
struct Rows {
    static constexpr auto name = py::detail::const_name("List[tuple]");
};

}  // namespace meaning

using Number = Typed<meaning::Number>;
using OptionalNumber = Typed<meaning::OptionalNumber>;
using Integer = Typed<meaning::Integer>;
using OptionalInteger = Typed<meaning::OptionalInteger>;
using Numbers = Typed<meaning::Numbers>;  ///< one number, an array or a sequence of them
using OptionalNumbers = Typed<meaning::OptionalNumbers>;
using Bends = Typed<meaning::Bends>;      ///< of each its angle in degrees, radius and place in m
using Sensors = Typed<meaning::Sensors>;  ///< ("tension", place in m) or ("displacement", "load")
using FourNumbers = Typed<meaning::FourNumbers>;
using Progress = Typed<meaning::Progress>;  ///< called with the activity and the fraction done
using Units = Typed<meaning::Units>;        ///< by the names of channels
using Rows = Typed<meaning::Rows>;          ///< of a table

}  // namespace capstan::python

namespace pybind11::detail {

template <typename Meaning>
struct handle_type_name<capstan::python::Typed<Meaning>> {
    static constexpr auto name = Meaning::name;
};

}  // namespace pybind11::detail
