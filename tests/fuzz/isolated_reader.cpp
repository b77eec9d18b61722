// For the targets of readers whose library runs in a process of its own. What the library does to itself
// there reaches nobody: the file is refused. So it is not a finding that libhdf5 reads beyond its memory, and
// a request for more than half a gigabyte fails for it, as the program's own limit makes one of 4 GB fail. A
// fault of our code remains one, in either process.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <vector>

extern "C" {

const char* __asan_default_suppressions();
const char* __asan_default_suppressions() {
    return "interceptor_via_lib:libhdf5\ninterceptor_via_lib:libmatio\n";
}
const char* __asan_default_options();
const char* __asan_default_options() {
    return "allocator_may_return_null=1:max_allocation_size_mb=512";
}

// The counters of covered edges, where clang has put them.
extern __attribute__((weak)) std::uint8_t __start___sancov_cntrs;
extern __attribute__((weak)) std::uint8_t __stop___sancov_cntrs;

/// Lets libFuzzer see what the reading process covers: the pages of counters are shared with it.
int LLVMFuzzerInitialize(int*, char***);
int LLVMFuzzerInitialize(int*, char***) {
    if (&__start___sancov_cntrs == nullptr) return 0;
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const auto begin = (reinterpret_cast<std::uintptr_t>(&__start___sancov_cntrs) + page - 1) / page * page;
    const auto end = reinterpret_cast<std::uintptr_t>(&__stop___sancov_cntrs) / page * page;
    if (begin >= end) return 0;
    auto* const counters = reinterpret_cast<std::uint8_t*>(begin);
    const std::vector<std::uint8_t> kept(counters, counters + (end - begin));
    void* const shared =
        ::mmap(counters, kept.size(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED, -1, 0);
    if (shared == MAP_FAILED) return 1;
    std::memcpy(shared, kept.data(), kept.size());
    return 0;
}

}  // extern "C"
