#include "capstan/gap/hypothesis.h"

#include <algorithm>

namespace capstan::gap {

namespace {

// What decides how a bench moves in a run.
struct Mechanics {
    std::vector<const CandidateCause*> causes;
    std::vector<double> numbers;

    bool operator==(const Mechanics&) const = default;
};

Mechanics mechanics_of(const Hypothesis& hypothesis, const BenchNumbers& in_run) {
    Mechanics mechanics{{}, {in_run.friction_ratio, in_run.stiffness_ratio, in_run.pretension_ratio}};
    const std::vector<FloatingNumber>& floating = hypothesis.bench->numbers;
    Eigen::Index next = 0;
    for (std::size_t k = 0; k < floating.size(); ++k, ++next) {
        if (k >= nominal_coordinates && !floating[k].of_a_sensor)
            mechanics.numbers.push_back(hypothesis.coordinates[next]);
    }
    for (const CandidateCause* cause : hypothesis.causes) {
        const auto count = static_cast<Eigen::Index>(cause->numbers.size());
        if (cause->family != "sensor" && !cause->is_of_runs && count > 0) {
            mechanics.causes.push_back(cause);
            for (Eigen::Index k = 0; k < count; ++k)
                mechanics.numbers.push_back(hypothesis.coordinates[next + k]);
        }
        next += count;
    }
    return mechanics;
}

}  // namespace

bool are_same_causes(const std::vector<const CandidateCause*>& one,
                     const std::vector<const CandidateCause*>& other) {
    return std::is_permutation(one.begin(), one.end(), other.begin(), other.end());
}

bool is_nothing(const std::vector<const CandidateCause*>& causes) {
    return causes.front()->effect == "none";
}

Hypothesis nominal_hypothesis(const BenchKnowledge& bench) {
    return {{}, Eigen::VectorXd::Zero(bench.size()), &bench};
}

BenchNumbers bench_numbers(const Hypothesis& hypothesis) {
    BenchNumbers bench;
    Eigen::Index next = 0;
    for (const FloatingNumber& number : hypothesis.bench->numbers)
        number.apply(bench, number.value(hypothesis.coordinates[next++]));
    for (const CandidateCause* cause : hypothesis.causes) {
        std::vector<double> values;
        for (const OpenNumber& number : cause->numbers)
            values.push_back(number.value(hypothesis.coordinates[next++]));
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
    const Eigen::Index floating = hypothesis.bench->size();
    Hypothesis kept{{}, hypothesis.coordinates.head(floating), hypothesis.bench};
    Eigen::Index next = floating;
    for (const CandidateCause* cause : hypothesis.causes) {
        const auto count = static_cast<Eigen::Index>(cause->numbers.size());
        if (keep(*cause)) kept = with_cause(kept, cause, hypothesis.coordinates.segment(next, count));
        next += count;
    }
    return kept;
}

std::vector<Hypothesis> without_each(const Hypothesis& hypothesis) {
    std::vector<Hypothesis> fewer;
    for (const CandidateCause* dropped : hypothesis.causes)
        fewer.push_back(
            only_causes(hypothesis, [&](const CandidateCause& cause) { return &cause != dropped; }));
    return fewer;
}

std::vector<SameBench> by_bench(std::span<const Hypothesis> hypotheses, const Recording& recording,
                                std::size_t run_index) {
    const RecordedRun& run = recording.runs[run_index];
    std::vector<SameBench> benches;
    std::vector<Mechanics> mechanics;
    for (std::size_t k = 0; k < hypotheses.size(); ++k) {
        BenchNumbers numbers = bench_numbers(hypotheses[k]).in_run(run);
        std::erase_if(numbers.sensor_faults, [&](const auto& fault) { return !run.drives(fault.first); });
        Mechanics its = mechanics_of(hypotheses[k], numbers);
        const auto same = std::find(mechanics.begin(), mechanics.end(), its);
        if (same != mechanics.end()) {
            benches[static_cast<std::size_t>(same - mechanics.begin())].hypotheses.push_back(k);
        } else {
            mechanics.push_back(std::move(its));
            benches.push_back({{run_index, std::move(numbers)}, {k}});
        }
    }
    return benches;
}

std::vector<BenchGroup> to_be_moved_at_once(std::vector<SameBench> benches, const Recording& recording) {
    const auto samples = [&](const SameBench& bench) { return recording.runs[bench.moved.run].samples(); };
    std::stable_sort(benches.begin(), benches.end(), [&](const SameBench& a, const SameBench& b) {
        const bool a_rings = a.moved.numbers.rings();
        const bool b_rings = b.moved.numbers.rings();
        return a_rings != b_rings ? a_rings : samples(a) > samples(b);
    });
    std::vector<BenchGroup> groups;
    for (SameBench& bench : benches) {
        if (groups.empty() || groups.back().size() == bench_lanes ||
            groups.back().front().moved.numbers.rings() != bench.moved.numbers.rings())
            groups.emplace_back();
        groups.back().push_back(std::move(bench));
    }
    return groups;
}

}  // namespace capstan::gap
