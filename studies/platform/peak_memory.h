#pragma once

#include <sys/resource.h>

#include <cstddef>

namespace capstan {

/// The most memory that this process has had so far [bytes].
inline std::size_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace capstan
