#include "capstan/gap/hypothesis.h"

#include <algorithm>
#include <cmath>

namespace capstan::gap {

BenchNumbers bench_numbers(const std::vector<const CandidateCause*>& causes,
                           const Eigen::VectorXd& coordinates) {
    BenchNumbers bench;
    // Wherever a search goes, the bench can still be built.
    const auto ratio = [](double logarithm) {
        constexpr double max_log = 2.5;
        return std::exp(std::clamp(logarithm, -max_log, max_log));
    };
    bench.friction_ratio = ratio(coordinates[0]);
    bench.stiffness_ratio = ratio(coordinates[1]);
    bench.pretension_ratio = ratio(coordinates[2]);
    Eigen::Index next = nominal_coordinates;
    for (const CandidateCause* cause : causes) {
        std::vector<double> values;
        for (const OpenNumber& number : cause->numbers) values.push_back(number.value(coordinates[next++]));
        cause->apply(bench, values);
    }
    return bench;
}

Hypothesis with_cause(Hypothesis present, const CandidateCause* cause, const Eigen::VectorXd& numbers) {
    present.causes.push_back(cause);
    const Eigen::Index known = present.coordinates.size();
    present.coordinates.conservativeResize(known + numbers.size());
    present.coordinates.tail(numbers.size()) = numbers;
    return present;
}

Hypothesis only_causes(const Hypothesis& hypothesis, const std::function<bool(const CandidateCause&)>& keep) {
    Hypothesis kept{{}, hypothesis.coordinates.head(nominal_coordinates)};
    Eigen::Index next = nominal_coordinates;
    for (const CandidateCause* cause : hypothesis.causes) {
        const auto count = static_cast<Eigen::Index>(cause->numbers.size());
        if (keep(*cause)) kept = with_cause(kept, cause, hypothesis.coordinates.segment(next, count));
        next += count;
    }
    return kept;
}

std::vector<SameBench> by_bench(std::span<const Hypothesis> hypotheses) {
    const auto moves_the_bench = [](const CandidateCause& cause) {
        return cause.family != "sensor" && !cause.numbers.empty();
    };
    std::vector<SameBench> benches;
    for (std::size_t k = 0; k < hypotheses.size(); ++k) {
        const Hypothesis mechanical = only_causes(hypotheses[k], moves_the_bench);
        const auto same = std::find_if(benches.begin(), benches.end(), [&](const SameBench& bench) {
            return bench.mechanical.causes == mechanical.causes &&
                   bench.mechanical.coordinates == mechanical.coordinates;
        });
        if (same != benches.end()) {
            same->hypotheses.push_back(k);
        } else {
            benches.push_back({mechanical, bench_numbers(mechanical.causes, mechanical.coordinates), {k}});
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
