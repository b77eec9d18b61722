#include "capstan/gap/same_benches.h"

#include <algorithm>

namespace capstan::gap {

namespace {

Hypothesis without_sensors(const Hypothesis& hypothesis) {
    Hypothesis mechanical{{}, hypothesis.coordinates.head(nominal_coordinates)};
    Eigen::Index next = nominal_coordinates;
    for (const CandidateCause* cause : hypothesis.causes) {
        const auto count = static_cast<Eigen::Index>(cause->numbers.size());
        if (cause->family != "sensor" && count > 0) {
            mechanical.causes.push_back(cause);
            const Eigen::Index known = mechanical.coordinates.size();
            mechanical.coordinates.conservativeResize(known + count);
            mechanical.coordinates.tail(count) = hypothesis.coordinates.segment(next, count);
        }
        next += count;
    }
    return mechanical;
}

}  // namespace

std::vector<SameBench> by_bench(std::span<const Hypothesis> hypotheses) {
    std::vector<SameBench> benches;
    for (std::size_t k = 0; k < hypotheses.size(); ++k) {
        const Hypothesis mechanical = without_sensors(hypotheses[k]);
        const auto same = std::find_if(benches.begin(), benches.end(), [&](const SameBench& bench) {
            return bench.mechanical.causes == mechanical.causes &&
                   bench.mechanical.coordinates == mechanical.coordinates;
        });
        if (same != benches.end()) {
            same->hypotheses.push_back(k);
        } else {
            benches.push_back(
                {mechanical, CauseFitter::numbers(mechanical.causes, mechanical.coordinates), {k}});
        }
    }
    return benches;
}

std::vector<BenchGroup> to_be_moved_at_once(const std::vector<SameBench>& benches) {
    std::vector<BenchGroup> groups;
    for (const bool rings : {false, true}) {
        BenchGroup group;
        for (const SameBench& bench : benches) {
            if (bench.numbers.rings() != rings) continue;
            group.push_back(bench);
            if (group.size() < bench_lanes) continue;
            groups.push_back(group);
            group.clear();
        }
        if (!group.empty()) groups.push_back(group);
    }
    return groups;
}

}  // namespace capstan::gap
