// The same walks for a coverage-guided fuzzer: link this instead of fuzz_step.cpp, with clang's
// -fsanitize=fuzzer.
#include "walk.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    capstan::fuzz::Tally tally;
    capstan::fuzz::walk(capstan::fuzz::Choices({data, size}), tally, nullptr);  // what it throws ends the run
    return 0;
}
