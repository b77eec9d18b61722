#pragma once
// What the sources of a room call where schemata.py has put its mutants in: each operator, literal and call
// takes its number, and the one that CAPSTAN_MUTANT names does something else. The test programs are built
// once for all of them. A file that CAPSTAN_MUTANTS_REACHED names gets a 1 at the place of each that is
// reached.

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cstdlib>

namespace capstan_mutants {

inline const int chosen = [] {
    const char* number = std::getenv("CAPSTAN_MUTANT");
    return number == nullptr ? 0 : std::atoi(number);
}();

// A mapped file also keeps what a process has reached that is killed.
inline unsigned char* const reached = [] {
    const char* path = std::getenv("CAPSTAN_MUTANTS_REACHED");
    const int file = path == nullptr ? -1 : open(path, O_RDWR);
    struct stat about {};
    if (file < 0 || fstat(file, &about) != 0) return static_cast<unsigned char*>(nullptr);
    void* const mapped = mmap(nullptr, about.st_size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    return mapped == MAP_FAILED ? nullptr : static_cast<unsigned char*>(mapped);
}();

[[gnu::always_inline]] inline bool active(int number) {
    if (reached != nullptr) reached[number] = 1;
    return number == chosen;
}

// An operator, and the one in its place.
#define CAPSTAN_SWAPPED(name, op, other)                                  \
    template <int number, typename Left, typename Right>                  \
    [[gnu::always_inline]] inline auto name(Left&& left, Right&& right) { \
        return active(number) ? left other right : left op right;         \
    }
CAPSTAN_SWAPPED(less, <, <=)
CAPSTAN_SWAPPED(less_or_equal, <=, <)
CAPSTAN_SWAPPED(greater, >, >=)
CAPSTAN_SWAPPED(greater_or_equal, >=, >)
CAPSTAN_SWAPPED(equal, ==, !=)
CAPSTAN_SWAPPED(unequal, !=, ==)
CAPSTAN_SWAPPED(plus, +, -)
CAPSTAN_SWAPPED(minus, -, +)
CAPSTAN_SWAPPED(times, *, /)
CAPSTAN_SWAPPED(divided, /, *)

template <int number, typename Left, typename Right>
[[gnu::always_inline]] inline Left& add_to(Left& left, Right&& right) {
    active(number) ? left -= right : left += right;
    return left;
}

template <int number, typename Left, typename Right>
[[gnu::always_inline]] inline Left& subtract_from(Left& left, Right&& right) {
    active(number) ? left += right : left -= right;
    return left;
}

template <int number, typename Value>
[[gnu::always_inline]] inline bool negated(const Value& value) {
    return active(number) != !value;
}

template <int number>
[[gnu::always_inline]] inline bool flag(bool value) {
    return active(number) != value;
}

template <int number, typename Integer>
[[gnu::always_inline]] inline Integer literal(Integer value) {
    return active(number) ? value + 1 : value;
}

// A function of vectors, and the one in its place.
template <int number, typename Other, typename Function, typename... Arguments>
[[gnu::always_inline]] inline auto call(Other other, Function function, Arguments... arguments) {
    return active(number) ? other(arguments...) : function(arguments...);
}

}  // namespace capstan_mutants
