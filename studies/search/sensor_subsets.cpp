#include "capstan/search/sensor_subsets.h"

#include <algorithm>
#include <bit>

namespace capstan {

namespace {

constexpr int max_direct_places = 16;

// binomial[n][k], Pascal's triangle.
std::vector<std::vector<double>> binomials(int n, int k) {
    std::vector<std::vector<double>> table(n + 1, std::vector<double>(k + 1, 0.0));
    for (int row = 0; row <= n; ++row) {
        table[row][0] = 1.0;
        for (int column = 1; column <= std::min(row, k); ++column) {
            table[row][column] = table[row - 1][column - 1] + table[row - 1][column];
        }
    }
    return table;
}

// The next larger number with as many bits (Gosper).
std::uint64_t next_with_as_many(std::uint64_t places) {
    const std::uint64_t lowest = places & (~places + 1);
    const std::uint64_t carried = places + lowest;
    return carried | (((places ^ carried) >> 2) / lowest);
}

}  // namespace

double SensorSubsets::how_many(int nodes, int max_sensors) {
    const std::vector<std::vector<double>> binomial = binomials(nodes, std::min(nodes, max_sensors));
    double sets = 0.0;
    for (const double of_a_size : binomial[nodes]) sets += of_a_size;
    return sets;
}

SensorSubsets::SensorSubsets(std::vector<int> nodes, int max_sensors)
    : nodes_(std::move(nodes)), max_sensors_(std::min(max_sensors, static_cast<int>(nodes_.size()))) {
    const int usable = static_cast<int>(nodes_.size());
    binomial_ = binomials(usable, max_sensors_);
    first_of_size_ = {0};
    places_ = {0};
    for (int size = 1; size <= max_sensors_; ++size) {
        first_of_size_.push_back(count());
        std::uint64_t places = (std::uint64_t{1} << size) - 1;
        for (const std::uint64_t past = std::uint64_t{1} << usable; places < past;
             places = next_with_as_many(places)) {
            places_.push_back(places);
        }
    }
    if (usable <= max_direct_places) {
        direct_.assign(std::size_t{1} << usable, -1);
        for (int subset = 0; subset < count(); ++subset) direct_[places_[subset]] = subset;
    }
    for (const std::uint64_t places : places_) sensors_.push_back(bits_in(places));
    without_last_.assign(count(), 0);
    last_place_.assign(count(), -1);
    for (int subset = 1; subset < count(); ++subset) {
        last_place_[subset] = 63 - std::countl_zero(places_[subset]);
        without_last_[subset] = at(places_[subset] & ~(std::uint64_t{1} << last_place_[subset]));
    }
    descend(0, 0);
}

void SensorSubsets::descend(int subset, int first_place) {
    if (subset != 0) depth_first_.push_back(subset);
    if (sensors(subset) == max_sensors_) return;
    for (int place = first_place; place < static_cast<int>(nodes_.size()); ++place) {
        descend(at(places_[subset] | std::uint64_t{1} << place), place + 1);
    }
}

std::vector<int> SensorSubsets::nodes_of(int subset) const {
    std::vector<int> nodes;
    for (std::uint64_t rest = places_[subset]; rest != 0; rest &= rest - 1) {
        nodes.push_back(nodes_[std::countr_zero(rest)]);
    }
    return nodes;
}

// Sets of one size stand in colexicographic order, so the rank of {p1 < p2 < ...} is the sum of C(p_j, j).
int SensorSubsets::rank(std::uint64_t places) const {
    double rank = first_of_size_[bits_in(places)];
    for (int j = 1; places != 0; places &= places - 1, ++j) rank += binomial_[std::countr_zero(places)][j];
    return static_cast<int>(rank);
}

int SensorSubsets::at(std::uint64_t places) const {
    return direct_.empty() ? rank(places) : direct_[places];
}

int SensorSubsets::find(const std::vector<int>& nodes) const {
    if (static_cast<int>(nodes.size()) > max_sensors_) return -1;
    std::uint64_t places = 0;
    for (const int node : nodes) {
        const auto place = std::lower_bound(nodes_.begin(), nodes_.end(), node);
        if (place == nodes_.end() || *place != node) return -1;
        places |= std::uint64_t{1} << (place - nodes_.begin());
    }
    return at(places);
}

}  // namespace capstan
