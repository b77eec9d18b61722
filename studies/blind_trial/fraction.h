#pragma once

namespace capstan::gap_trial {

/// A count of hits among cases, with Wilson's 95% interval (1927) for the probability behind it.
struct Fraction {
    int hits = 0;
    int of = 0;

    void count(bool hit) {
        ++of;
        hits += hit ? 1 : 0;
    }
    double value() const { return of > 0 ? static_cast<double>(hits) / of : 0.0; }
    double low() const;
    double high() const;
};

}  // namespace capstan::gap_trial
