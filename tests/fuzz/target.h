#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

/// What a coverage-guided fuzzer calls with one input after the other (libFuzzer's name), and replay.cpp with
/// those of files. Returns if the program did as it promises: took the input, or refused it in words of its
/// own. Whatever else it throws ends the run, and is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace capstan::fuzz {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// A promise that was broken without anything being thrown.
struct Finding : std::logic_error {
    using std::logic_error::logic_error;
};

inline void demand(bool kept, const std::string& promise) {
    if (!kept) throw Finding(promise);
}

}  // namespace capstan::fuzz
