#pragma once

#include <malloc.h>

namespace capstan {

/// From now on the process keeps what it frees, up to 256 MB, instead of giving it back to the system. For a
/// command that allocates matrices of some megabytes again and again: each would be given back, asked for
/// anew and cleared by the kernel.
inline void keep_freed_memory() {
    constexpr int megabyte = 1 << 20;
    mallopt(M_MMAP_THRESHOLD, 32 * megabyte);  // the most that the C library accepts
    mallopt(M_TRIM_THRESHOLD, 256 * megabyte);
}

}  // namespace capstan
