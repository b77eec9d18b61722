#pragma once

#include <cstdint>
#include <vector>

namespace capstan {

/// Bits set in a mask, in a few instructions also where the processor's own may not be assumed.
constexpr int bits_in(std::uint64_t mask) {
    mask -= mask >> 1 & 0x5555555555555555;
    mask = (mask & 0x3333333333333333) + (mask >> 2 & 0x3333333333333333);
    mask = (mask + (mask >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return static_cast<int>(mask * 0x0101010101010101 >> 56);
}

/// All sets of at most `max_sensors` out of the usable nodes, the empty one first, then by size. Every set
/// is another set plus one sensor, the last (most distal) of its own: walked that way a sum over a set is the
/// sum over the smaller set plus one term, in the order of the sensors, so it has the same bits as if it had
/// been summed alone.
///
/// A set is written as places: bit p is the p-th usable node.
class SensorSubsets {
  public:
    /// `nodes`: usable nodes from 0, rising, at most 63; how_many() must fit into memory.
    SensorSubsets(std::vector<int> nodes, int max_sensors);

    /// Sets that there would be, the empty one included.
    static double how_many(int nodes, int max_sensors);

    int count() const { return static_cast<int>(places_.size()); }
    const std::vector<int>& usable_nodes() const { return nodes_; }
    int max_sensors() const { return max_sensors_; }

    std::uint64_t places(int subset) const { return places_[subset]; }
    int sensors(int subset) const { return sensors_[subset]; }
    std::vector<int> nodes_of(int subset) const;  ///< from 0, rising
    /// The set without its last sensor, and that sensor's place. Not for the empty set.
    int without_last(int subset) const { return without_last_[subset]; }
    int last_place(int subset) const { return last_place_[subset]; }
    /// All sets but the empty one, each right after those it begins with: a stack of running sums serves.
    const std::vector<int>& depth_first() const { return depth_first_; }

    /// The set with these places; they must be at most `max_sensors`.
    int at(std::uint64_t places) const;
    /// The set of these nodes; -1 if one is not usable or they are too many.
    int find(const std::vector<int>& nodes) const;

  private:
    int rank(std::uint64_t places) const;
    void descend(int subset, int first_place);

    std::vector<int> nodes_;
    int max_sensors_;
    std::vector<int> first_of_size_;             // sizes
    std::vector<std::vector<double>> binomial_;  // places + 1 x sizes + 1
    std::vector<std::uint64_t> places_;          // subsets
    std::vector<int> sensors_;                   // subsets
    std::vector<int> without_last_;              // subsets
    std::vector<int> last_place_;                // subsets
    std::vector<int> depth_first_;
    std::vector<int> direct_;  // by places, while there are few of them; else empty
};

}  // namespace capstan
