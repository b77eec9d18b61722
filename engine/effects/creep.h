#pragma once

namespace capstan {

/// A viscoelastic cable (E32, Kelvin-Voigt element in series): strain that follows `ratio` T / EA with a time
/// constant.
struct Creep {
    double ratio = 0.0;
    double time_constant_s = 2.0;
};

}  // namespace capstan
