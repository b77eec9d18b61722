#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

namespace capstan::python {

namespace py = pybind11;

// What a caller gave, as plain numbers. Each throws InvalidInput that names the argument and says what it is
// and what it must be; whether the numbers make sense is the library's to say.

/// One finite or infinite number, also of NumPy.
double number_of(const py::handle& given, const std::string& name);
/// A whole number within these limits, both allowed.
struct IntegerRange {
    long long low = -2147483648LL;
    long long high = 2147483647LL;
};
long long integer_of(const py::handle& given, const std::string& name, const IntegerRange& range = {});
/// The number of threads of a call; 0: all processors.
int jobs_of(const py::handle& given);
/// An array of one dimension, or any sequence of numbers: of any stride, byte order and kind of real number
/// that a double holds.
std::vector<double> numbers_of(const py::handle& given, const std::string& name);
/// The same, where one number stands for all draws, and None for the cable's own.
std::vector<double> draws_of(const py::handle& given, const std::string& name);

/// Memory for an array, not yet written.
struct ArrayMemory {
    std::unique_ptr<double[]> numbers;
    std::vector<py::ssize_t> shape;

    explicit ArrayMemory(std::vector<py::ssize_t> of_shape);
    std::size_t size() const;
};
/// The array, which owns its memory. Nothing is copied.
py::array_t<double> array_of(ArrayMemory memory);
/// A read-only array of numbers that `owner` keeps alive. Nothing is copied.
py::array_t<double> view_of(const std::vector<double>& numbers, const py::handle& owner);

}  // namespace capstan::python
