#pragma once

#include <string>

namespace capstan::cli {

/// The widest vector instructions in use, by Highway's name: "SCALAR", "SSSE3", "SSE4", "AVX2", "AVX3".
std::string simd_in_use();

/// Takes no wider instructions than the environment variable CAPSTAN_SIMD names, for a proof that results do
/// not hang on the processor; without it all that the processor has. To be called before the first step.
/// Throws UsageError for a name that this processor or this program does not have.
void limit_simd_from_environment();

}  // namespace capstan::cli
