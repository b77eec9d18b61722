// Loaded before the program (LD_PRELOAD): lets one request for memory fail, counted from the beginning of
// main(). What is to fail is the request's number, from 1; 0: none. forked_main.h tells how it is asked for.
#include <atomic>
#include <cerrno>
#include <cstddef>

#include "forked_main.h"

extern "C" {

// What glibc's own names stand for.
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

static std::atomic<long> requests{0};
static long fails_at = 0;
static std::atomic<bool> counting{false};

static bool fails() {
    if (!counting.load(std::memory_order_relaxed)) return false;
    if (requests.fetch_add(1) + 1 != fails_at) return false;
    errno = ENOMEM;
    return true;
}

void* malloc(std::size_t bytes) {
    return fails() ? nullptr : __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) {
    return fails() ? nullptr : __libc_calloc(count, bytes);
}
void* realloc(void* memory, std::size_t bytes) {
    return fails() ? nullptr : __libc_realloc(memory, bytes);
}
void* memalign(std::size_t alignment, std::size_t bytes) {
    return fails() ? nullptr : __libc_memalign(alignment, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
    return fails() ? nullptr : __libc_memalign(alignment, bytes);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
    if (fails()) return ENOMEM;
    *memory = __libc_memalign(alignment, bytes);
    return *memory == nullptr ? ENOMEM : 0;
}

}  // extern "C"

void faults::begin(const char* line) {
    fails_at = std::atol(line);
    counting = true;
}

void faults::end() {
    counting = false;
    say_count(requests.load());
}
