#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace capstan {

/// The vector instructions in use, by Highway's name: "SCALAR", "SSSE3", "SSE4", "AVX2", "AVX3". Another
/// width adds in another order, so that the last bits of a result may differ.
std::string simd_width();

/// Those that this program on this processor could use, widest first.
std::vector<std::string> simd_widths();

/// Takes no wider instructions than the named ones from now on. To be called before the first step of a
/// cable, since functions that were chosen stay. False, and nothing changes, for a name that is not among
/// simd_widths().
bool limit_simd_width(std::string_view name);

}  // namespace capstan
