#include "capstan/search/subset_votes.h"

#include <bit>

#include "capstan/estimation/consensus.h"
#include "capstan/search/sensor_subsets.h"

namespace capstan {

void SubsetVotes::read(const SensorEstimates& estimates) {
    const int places = static_cast<int>(usable_nodes_.size());
    nodes_ = estimates.nodes;
    resting_.assign(places, 0);
    same_.assign(places, 0);
    perhaps_resting_ = 0;
    unverified_ = 0;
    for (int p = 0; p < places; ++p) {
        const DirectionBits& vote = estimates.directions[usable_nodes_[p]];
        const std::uint64_t bit = std::uint64_t{1} << p;
        const std::uint64_t moving = moving_nodes(vote);
        if (!estimates.verified[usable_nodes_[p]]) unverified_ |= bit;
        for (int q = 0; q < places; ++q) {
            if ((moving >> usable_nodes_[q] & 1) == 0) resting_[q] |= bit;
            if (estimates.directions[usable_nodes_[q]] == vote) same_[p] |= std::uint64_t{1} << q;
        }
    }
    for (int p = 0; p < places; ++p) {
        if (resting_[p] != 0) perhaps_resting_ |= std::uint64_t{1} << p;
    }
    segments_.clear();
    for (int segment = 0; segment + 1 < nodes_; ++segment) {
        std::uint64_t forward = 0;
        std::uint64_t backward = 0;
        for (int p = 0; p < places; ++p) {
            const DirectionBits& vote = estimates.directions[usable_nodes_[p]];
            forward |= (vote.forward >> segment & 1) << p;
            backward |= (vote.backward >> segment & 1) << p;
        }
        if (!segments_.empty() && segments_.back().forward == forward &&
            segments_.back().backward == backward) {
            segments_.back().end = segment + 1;
        } else {
            segments_.push_back({segment, segment + 1, forward, backward, 0});
        }
    }
}

std::uint64_t SubsetVotes::used(std::uint64_t set) const {
    const int count = bits_in(set);
    std::uint64_t used = set;
    for (std::uint64_t rest = set & perhaps_resting_; rest != 0; rest &= rest - 1) {
        const int place = std::countr_zero(rest);
        if (2 * bits_in(set & resting_[place]) > count) used &= ~(std::uint64_t{1} << place);
    }
    return used == 0 ? set : used;
}

bool SubsetVotes::alike(std::uint64_t set) const {
    return (set & ~same_[std::countr_zero(set)]) == 0;
}

std::span<const SubsetVotes::NodeRun> SubsetVotes::agreement(std::uint64_t set, std::uint64_t used) {
    const int count = bits_in(set);
    const int low = (count - 1) / 2;
    const int high = count / 2;
    for (SegmentRun& run : segments_) {
        // In rising order: all backward, then all at rest, then all forward; the median is at `low` and
        // `high`, and where these differ nobody agrees.
        const std::uint64_t backward = set & run.backward;
        const std::uint64_t forward = set & run.forward;
        const int first_at_rest = bits_in(backward);
        const int first_forward = count - bits_in(forward);
        if (high < first_at_rest) {
            run.agreeing = backward;
        } else if (low >= first_forward) {
            run.agreeing = forward;
        } else if (low >= first_at_rest && high < first_forward) {
            run.agreeing = set & ~backward & ~forward;
        } else {
            run.agreeing = 0;
        }
    }
    runs_.clear();
    const auto add = [&](int first, int end, std::uint64_t agreeing) {
        if (first >= end) return;
        const std::uint64_t who = (agreeing | unverified_) & used;
        if (!runs_.empty() && runs_.back().agreeing == who) {
            runs_.back().end = end;
        } else {
            runs_.push_back({first, end, who});
        }
    };
    std::uint64_t before = ~std::uint64_t{0};  // the first node has no segment before it
    for (const SegmentRun& run : segments_) {
        add(run.first, run.first + 1, before & run.agreeing);
        add(run.first + 1, run.end, run.agreeing);
        before = run.agreeing;
    }
    add(nodes_ - 1, nodes_, before);
    return runs_;
}

}  // namespace capstan
