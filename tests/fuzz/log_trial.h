#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace capstan::fuzz {

/// Reads a log, after `magic` in front of it has made it one of the format under trial where it is not one.
/// Refusals are fine; what is read must be consistent.
void try_log(const std::uint8_t* data, std::size_t size, std::string_view magic = {});

}  // namespace capstan::fuzz
