// The step and the pull-pull pair on random benches with random inputs: fuzz_step.cpp's walks, led by
// coverage.
#include "target.h"
#include "walk.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    capstan::fuzz::Tally tally;
    capstan::fuzz::walk(capstan::fuzz::Choices({data, size}), tally, nullptr);
    return 0;
}
