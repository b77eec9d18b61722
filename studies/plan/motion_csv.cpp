#include <fmt/format.h>

#include <iterator>

#include "capstan/cable/motion_name.h"
#include "capstan/plan/true_motion.h"

namespace capstan {

namespace {

std::string motion_head(int nodes) {
    std::string line =
        "sample,time_s,motion,regime,proximal_moving_nodes,distal_moving_nodes,proximal_direction,distal_direction,"
        "verified";
    for (int node = 1; node <= nodes; ++node) line += fmt::format(",tension_{}_N", node);
    for (int node = 1; node <= nodes; ++node) line += fmt::format(",displacement_{}_m", node);
    return line + "\n";
}

void append_sample(std::string& text, const TrueSample& sample, double sample_rate_Hz) {
    const MotionPattern& pattern = sample.report.pattern;
    const auto regime = regime_of(pattern);
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{},{},{},{},{},{},{},{},{}", sample.sample, sample.sample / sample_rate_Hz,
                   name_of(pattern.kind), regime ? name_of(*regime) : "", pattern.proximal_moving_nodes,
                   pattern.distal_moving_nodes, sign(pattern.proximal_direction),
                   sign(pattern.distal_direction), sample.report.verified ? 1 : 0);
    for (const double tension_N : sample.now.tension_N) fmt::format_to(out, ",{}", tension_N);
    for (const double displacement_m : sample.now.displacement_m) fmt::format_to(out, ",{}", displacement_m);
    text += "\n";
}

}  // namespace

std::string motion_csv(const StudyPlan& plan) {
    const QuasiStaticStep step(Cable(plan.transmission.cable), plan.transmission.rules);
    const CableState start = pretensioned(step.cable());
    const StepReport at_rest{};
    std::string text = motion_head(step.cable().nodes());
    append_sample(text, {0, start, start, at_rest}, plan.motion.sample_rate_Hz);
    simulate(step, plan.motion,
             [&](const TrueSample& sample) { append_sample(text, sample, plan.motion.sample_rate_Hz); });
    return text;
}

}  // namespace capstan
