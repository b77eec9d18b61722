#pragma once

#include <array>
#include <bit>
#include <cstddef>

namespace capstan {

/// One of each effect.
template <class... Effects>
struct EffectSet : Effects... {
    template <class Effect>
    Effect& of() {
        return *this;
    }
    template <class Effect>
    const Effect& of() const {
        return *this;
    }
};

/// Laws of the cable: class templates over the number that a law computes with.
template <template <class> class... Laws>
struct LawList {};

/// Those of a set's effects that are laws of the cable.
template <class Set, class Found = LawList<>>
struct CableLawsOf {
    using List = Found;
};
template <class First, class... Rest, class Found>
struct CableLawsOf<EffectSet<First, Rest...>, Found> : CableLawsOf<EffectSet<Rest...>, Found> {};
template <template <class> class First, class... Rest, template <class> class... Found>
struct CableLawsOf<EffectSet<First<double>, Rest...>, LawList<Found...>>
    : CableLawsOf<EffectSet<Rest...>, LawList<Found..., First>> {};

template <template <class> class Law>
inline constexpr std::size_t law_parameters = sizeof(Law<double>) / sizeof(double);

/// The parameters in the order of their declaration.
template <template <class> class Law>
std::array<double, law_parameters<Law>> parameters_of(const Law<double>& law) {
    return std::bit_cast<std::array<double, law_parameters<Law>>>(law);
}

}  // namespace capstan
