#pragma once

#include <vector>

#include "capstan/worlds/error_table.h"

namespace capstan {

/// A fraction of the true tensions, over worlds, with its standard error.
struct CoveredFraction {
    double value = 0.0;
    double standard_error = 0.0;

    /// Beyond 93 to 97% by more than two standard errors.
    bool is_exception() const;
};

/// How often the estimator's 95% band holds the true tension with the sensors of a candidate.
struct BandCoverage {
    int candidate = 0;
    CoveredFraction as_stated;  ///< worlds drawn from what the estimator is told
    CoveredFraction wider;      ///< worlds twice as uncertain as that
};

/// Of every candidate of the table, over its first `worlds` worlds. Throws TableStopped.
std::vector<BandCoverage> band_coverage(ErrorTable& table, int worlds);

}  // namespace capstan
