#include "capstan/worlds/band_coverage.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace capstan {

namespace {

CoveredFraction covered_fraction(const ErrorTable& table, Condition condition, int candidate, int worlds) {
    CoveredFraction covered;
    double squares = 0.0;
    for (int world = 0; world < worlds; ++world) {
        const double each = table.at(condition, candidate, world).covered_fraction;
        covered.value += each / worlds;
        squares += each * each / worlds;
    }
    const double variance = std::max(squares - covered.value * covered.value, 0.0);
    covered.standard_error = std::sqrt(variance / std::max(worlds - 1, 1));
    return covered;
}

}  // namespace

bool CoveredFraction::is_exception() const {
    const double open = 2.0 * standard_error;
    return value + open < 0.93 || value - open > 0.97;
}

std::vector<BandCoverage> band_coverage(ErrorTable& table, int worlds) {
    std::vector<int> all(table.candidates().size());
    std::iota(all.begin(), all.end(), 0);
    for (const Condition condition : {Condition::as_stated, Condition::wider_worlds})
        table.fill(condition, all, 0, worlds, name_of(condition));
    std::vector<BandCoverage> bands;
    for (const int candidate : all)
        bands.push_back({candidate, covered_fraction(table, Condition::as_stated, candidate, worlds),
                         covered_fraction(table, Condition::wider_worlds, candidate, worlds)});
    return bands;
}

}  // namespace capstan
