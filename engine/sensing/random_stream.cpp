#include "capstan/sensing/random_stream.h"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

namespace capstan {

namespace {

// 64 random bits to (0, 1): the top 53, centred in their step so that neither 0 nor 1 comes out.
double open_unit_interval(std::uint32_t high, std::uint32_t low) {
    const std::uint64_t bits = (std::uint64_t{high} << 32) | low;
    return (static_cast<double>(bits >> 11) + 0.5) * 0x1.0p-53;
}

}  // namespace

std::array<double, 2> standard_normals(const RandomAddress& address) {
    const r123::Philox4x32::key_type key{
        {static_cast<std::uint32_t>(address.seed), static_cast<std::uint32_t>(address.seed >> 32)}};
    const r123::Philox4x32::ctr_type counter{
        {address.node, address.repetition, address.scenario, static_cast<std::uint32_t>(address.purpose)}};
    const r123::Philox4x32::ctr_type bits = r123::Philox4x32{}(counter, key);
    const double radius = std::sqrt(-2.0 * std::log(open_unit_interval(bits[0], bits[1])));
    const double angle = 2.0 * std::numbers::pi * open_unit_interval(bits[2], bits[3]);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace capstan
