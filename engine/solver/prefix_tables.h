#pragma once

#include <array>
#include <cstddef>
#include <new>
#include <span>
#include <vector>

#include "capstan/cable/cable.h"
#include "capstan/solver/model_rules.h"

namespace capstan {

/// An integer number of SIMD vectors lies in a cache line, if the first one begins there.
template <class T>
struct CacheLineAllocator {
    using value_type = T;
    static constexpr std::align_val_t line_bytes{64};

    CacheLineAllocator() = default;
    template <class Other>
    CacheLineAllocator(const CacheLineAllocator<Other>&) {}

    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), line_bytes)); }
    void deallocate(T* first, std::size_t) { ::operator delete(first, line_bytes); }
    friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};
using NodeTable = std::vector<double, CacheLineAllocator<double>>;

/// Elongation [m] of a sliding segment per newton at its first node, whose tension grows by exp(exponent)
/// along it (E2).
double sliding_elongation_m_per_N(ElongationRule rule, double compliance_m_per_N, double exponent);

/// All nodes of a sliding side follow from its end node (E1, E2). Arrays are in node order for both ends:
/// T_node = T_end * tension_ratio[node], |u_node - u_end| = T_end * elongation_m_per_N[node].
struct SideTable {
    NodeTable tension_ratio;       // nodes
    NodeTable elongation_m_per_N;  // nodes
    /// The same elongation to the next node outward, taken as half a segment at rest (E3's h added):
    /// displacement of the end per newton when this node is the last one moving.
    NodeTable front_compliance_m_per_N;  // nodes
};

/// Everything about a cable that a step needs and that does not change from step to step.
struct PrefixTables {
    PrefixTables(const Cable& cable, const ModelRules& rules);

    /// Other exponents, and mu_s as mu_d, under ElongationRule::mean_tension. Allocates nothing.
    void set_sliding_exponents(std::span<const double> exponents);  // segments

    /// The same from segments that are already known, under ElongationRule::mean_tension; the cut stays.
    void assign(double mean_compliance_m_per_N, const double* sliding_exponent, const double* sliding_ratio,
                const double* breakaway_ratio, std::size_t stride);

    const SideTable& proximal(int direction_sign) const { return proximal_[direction_sign > 0]; }
    const SideTable& distal(int direction_sign) const { return distal_[direction_sign > 0]; }

    std::vector<double> relative_position;        // nodes: in mean segments from the proximal end
    std::vector<double> half_compliance_m_per_N;  // segments: h of E3, dx / (2 EA)
    std::vector<double> sliding_exponent;         // segments: mu_d times wrap angle
    std::vector<double> sliding_ratio;            // segments: exp(sliding_exponent)
    std::vector<double> breakaway_ratio;          // segments: exp(mu_s times wrap angle)

  private:
    void fill_sides();

    std::array<SideTable, 2> proximal_;  // backward, forward
    std::array<SideTable, 2> distal_;
};

}  // namespace capstan
