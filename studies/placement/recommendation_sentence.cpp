#include <algorithm>
#include <cmath>

#include "capstan/placement/recommendation.h"

namespace capstan {

namespace {

std::string with_digits(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string scope_words(const storage::RecommendationRecord& r) {
    if (r.scope == "minimax_regret") return "To be safe in every regime";
    if (r.scope == "duty_cycle") return "Over the duty cycle";
    if (r.regime == "mass") return "When the whole cable moves";
    if (r.regime == "partial_proximal") return "When only the motor side moves";
    if (r.regime == "partial_distal") return "When only the load side moves";
    return "When both sides move and the middle rests";
}

// What the paper would call the set, if it has a name for it. Several families can share one: the plainest
// name wins.
std::string layout_words(const storage::StudyDescription& study, int set_index) {
    if (static_cast<int>(study.sensor_sets[set_index].nodes.size()) == study.study.segments + 1) {
        return " (every node)";
    }
    for (const char* family : {"distal", "both", "even"}) {
        for (const storage::LayoutRecord& layout : study.layouts) {
            if (layout.set_index == set_index && layout.family == family) {
                return " (" + layout.label.substr(0, layout.label.find(',')) + ")";
            }
        }
    }
    return "";
}

std::string node_words(const std::vector<int>& nodes) {
    std::string text = nodes.size() == 1 ? "node " : "nodes ";
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const bool last = k + 1 == nodes.size();
        text += (k == 0 ? "" : last ? " and " : ", ") + std::to_string(nodes[k]);
    }
    return text;
}

std::string error_words(const storage::RecommendationRecord& r) {
    const std::string interval =
        with_digits(r.interval_low_N, 3) + " to " + with_digits(r.interval_high_N, 3) + " N at 95%";
    if (r.scope == "minimax_regret") {
        return "it is at most " + with_digits(r.error_N, 3) + " N (" + interval +
               ") worse than the best choice of any regime";
    }
    return "the mean tension error is " + with_digits(r.error_N, 3) + " N (" + interval + ")";
}

// Draws that chose the best of many flatter it.
std::string optimism_words(const storage::RecommendationRecord& r) {
    const double optimism_N = r.error_N - searched_error_N(r);
    return "This is from fresh draws; on those that chose it, it looked " +
           with_digits(std::abs(optimism_N), 4) + (optimism_N < 0.0 ? " N worse." : " N better.");
}

std::string gain_words(const storage::RecommendationRecord& r, double worthwhile_gain_N) {
    const auto next = std::find_if(r.counts.begin(), r.counts.end(),
                                   [&](const auto& count) { return count.sensor_count > r.sensor_count; });
    if (next == r.counts.end()) return "No larger count was studied.";
    const double gain_N = searched_error_N(r) - next->error_N;
    const int added = next->sensor_count - r.sensor_count;
    const std::string more = added == 1 ? "One more sensor" : std::to_string(added) + " more sensors";
    if (gain_N <= 0.0) return more + " would gain nothing.";
    return more + " would gain " + with_digits(gain_N, 3) + " N; a sensor is worth " +
           with_digits(worthwhile_gain_N, 3) + " N here.";
}

std::string alternative_words(const storage::RecommendationRecord& r) {
    const std::size_t count = r.alternatives.size();
    if (count == 0) return "Every other choice with as many sensors is worse beyond doubt.";
    return std::to_string(count) + (count == 1 ? " other choice" : " other choices") +
           " with as many sensors cannot be told from it.";
}

}  // namespace

std::string recommendation_sentence(const storage::StudyDescription& study,
                                    const storage::RecommendationRecord& r, double worthwhile_gain_N) {
    const auto method = std::find_if(study.fusion_methods.begin(), study.fusion_methods.end(),
                                     [&](const auto& m) { return m.method == r.method; });
    const std::string count =
        std::to_string(r.sensor_count) + (r.sensor_count == 1 ? " sensor at " : " sensors at ");
    return scope_words(r) + " (noise " + study.noise_levels[r.noise_index].label + "): put " + count +
           node_words(study.sensor_sets[r.set_index].nodes) + layout_words(study, r.set_index) +
           " and fuse by " + method->title + "; " + error_words(r) + ". " + optimism_words(r) + " " +
           gain_words(r, worthwhile_gain_N) + " " + alternative_words(r);
}

}  // namespace capstan
