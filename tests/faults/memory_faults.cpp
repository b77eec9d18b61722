// Loaded before the program (LD_PRELOAD): lets one request for memory fail, counted from the beginning of
// main().
//   CAPSTAN_FAULT_AT     which one, from 1; 0: none
//   CAPSTAN_FAULT_COUNT  a file that gets the number of requests when main() has returned
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

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

using Main = int(int, char**, char**);
static Main* real_main = nullptr;

static int counted_main(int count, char** words, char** environment) {
    counting = true;
    const int code = real_main(count, words, environment);
    counting = false;
    if (const char* path = std::getenv("CAPSTAN_FAULT_COUNT")) {
        char text[32];
        const int length = std::snprintf(text, sizeof text, "%ld\n", requests.load());
        const int file = ::open(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
        if (file >= 0) {
            if (::write(file, text, static_cast<std::size_t>(length)) < 0) std::perror(path);
            ::close(file);
        }
    }
    return code;
}

int __libc_start_main(Main* main, int count, char** words, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
    using Start = int(Main*, int, char**, void (*)(), void (*)(), void (*)(), void*);
    auto* const start = reinterpret_cast<Start*>(dlsym(RTLD_NEXT, "__libc_start_main"));
    if (const char* at = std::getenv("CAPSTAN_FAULT_AT")) fails_at = std::atol(at);
    real_main = main;
    return start(counted_main, count, words, init, fini, rtld_fini, stack_end);
}

}  // extern "C"
