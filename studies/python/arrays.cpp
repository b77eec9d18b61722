#include "arrays.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <limits>
#include <memory>

#include "capstan/cable/invalid_input.h"

namespace capstan::python {

namespace {

[[noreturn]] void refuse_argument(const std::string& name, const std::string& is_and_must) {
    throw InvalidInput({fmt::format("{}: {}", name, is_and_must)});
}

std::string type_name(const py::handle& given) {
    return py::str(py::type::handle_of(given).attr("__name__"));
}

std::string shape_words(const py::array& array) {
    return py::str(array.attr("shape"));
}

// Real numbers that a double holds.
bool is_real(const py::dtype& kind) {
    return kind.kind() == 'i' || kind.kind() == 'u' || (kind.kind() == 'f' && kind.itemsize() <= 8);
}

bool is_masked(const py::handle& given) {
    return py::hasattr(given, "mask") &&
           py::module_::import("numpy.ma").attr("is_masked")(given).cast<bool>();
}

py::array_t<double> real_array(const py::handle& given, const std::string& name) {
    const py::array array = py::array::ensure(given);  // clears Python's error
    if (!array)
        refuse_argument(name, fmt::format("is a {} that is not an array of numbers", type_name(given)));
    if (!is_real(array.dtype()))
        refuse_argument(name, fmt::format("holds {} ({}), but must hold real numbers that fit 64 bits",
                                          std::string(py::str(array.dtype())), type_name(given)));
    if (is_masked(given)) refuse_argument(name, "has masked numbers; leave them out or fill them");
    return py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
}

std::vector<double> copied(const py::array_t<double>& array) {
    return {array.data(), array.data() + array.size()};
}

}  // namespace

double number_of(const py::handle& given, const std::string& name) {
    const py::array_t<double> array = real_array(given, name);
    if (array.ndim() != 0)
        refuse_argument(name, fmt::format("has the shape {}, but must be one number", shape_words(array)));
    return *array.data();
}

long long integer_of(const py::handle& given, const std::string& name, const IntegerRange& range) {
    const py::object index = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
    if (!index) {
        PyErr_Clear();
        refuse_argument(name, fmt::format("is a {}, but must be a whole number", type_name(given)));
    }
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    if (overflow != 0 || value > range.high || value < range.low)
        refuse_argument(name, fmt::format("is {}, but must be {} to {}",
                                          std::string(py::repr(index)).substr(0, 40), range.low, range.high));
    return value;
}

int jobs_of(const py::handle& given) {
    return static_cast<int>(integer_of(given, "jobs", {0, 1024}));
}

std::vector<double> numbers_of(const py::handle& given, const std::string& name) {
    const py::array_t<double> array = real_array(given, name);
    if (array.ndim() != 1)
        refuse_argument(name,
                        fmt::format("has the shape {}, but must have one dimension", shape_words(array)));
    return copied(array);
}

std::vector<double> draws_of(const py::handle& given, const std::string& name) {
    if (given.is_none()) return {};
    const py::array_t<double> array = real_array(given, name);
    if (array.ndim() > 1)
        refuse_argument(name, fmt::format("has the shape {}, but must be one number, or one for each draw",
                                          shape_words(array)));
    if (array.size() == 0) refuse_argument(name, "has no draws; give at least one, or None");
    return copied(array);
}

namespace {

// Threads that write new memory take turns at the kernel for each page, so large arrays ask for large pages.
void ask_for_large_pages(void* memory, std::size_t bytes) {
    constexpr std::size_t page_bytes = std::size_t{2} << 20;
    void* first = memory;
    if (std::align(page_bytes, page_bytes, first, bytes) == nullptr) return;
    madvise(first, bytes / page_bytes * page_bytes, MADV_HUGEPAGE);  // a hint: without it all is as before
}

}  // namespace

ArrayMemory::ArrayMemory(std::vector<py::ssize_t> of_shape) : shape(std::move(of_shape)) {
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<py::ssize_t>::max()) / sizeof(double);
    std::size_t count = 1;
    for (const py::ssize_t length : shape) {
        if (length != 0 && count > most / static_cast<std::size_t>(length)) throw std::bad_alloc();
        count *= static_cast<std::size_t>(length);
    }
    numbers = std::make_unique_for_overwrite<double[]>(count);
    ask_for_large_pages(numbers.get(), count * sizeof(double));
}

std::size_t ArrayMemory::size() const {
    std::size_t count = 1;
    for (const py::ssize_t length : shape) count *= static_cast<std::size_t>(length);
    return count;
}

py::array_t<double> array_of(ArrayMemory memory) {
    double* const numbers = memory.numbers.get();
    const py::capsule owner(numbers, [](void* held) { delete[] static_cast<double*>(held); });
    memory.numbers.release();  // the capsule's from here on
    return py::array_t<double>(memory.shape, numbers, owner);
}

py::array_t<double> view_of(const std::vector<double>& numbers, const py::handle& owner) {
    py::array_t<double> view({static_cast<py::ssize_t>(numbers.size())}, numbers.data(), owner);
    view.attr("flags").attr("writeable") = false;
    return view;
}

}  // namespace capstan::python
