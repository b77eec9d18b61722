#include <algorithm>
#include <cmath>
#include <set>

#include "capstan/placement/recommendation.h"
#include "capstan/storage/error.h"

namespace capstan {

namespace {

// Errors and gains are given to 0.001 N.
constexpr double smallest_shown_N = 0.0005;

std::string with_digits(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string newtons(double value_N) {
    return with_digits(value_N, 3) + " N";
}

std::string sensors(int count) {
    return std::to_string(count) + (count == 1 ? " sensor" : " sensors");
}

std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t k = 0; k < words.size(); ++k) {
        const bool last = k + 1 == words.size();
        text += (k == 0 ? "" : last ? " and " : ", ") + words[k];
    }
    return text;
}

// nodes: positions along the cable, from the motor end.
std::vector<double> node_positions_m(const storage::StudyDescription& study) {
    std::vector<double> position_m;
    for (const storage::CableSegmentRecord& segment : study.cable_segments) {
        if (position_m.empty()) position_m.push_back(segment.start_m);
        position_m.push_back(segment.start_m + segment.length_m);
    }
    return position_m;
}

// With as few decimals, one to three, as show every place to the millimetre.
int place_decimals(const std::vector<double>& position_m) {
    for (int decimals = 1; decimals < 3; ++decimals) {
        const double scale = std::pow(10.0, decimals);
        const bool exact = std::all_of(position_m.begin(), position_m.end(), [&](double place_m) {
            return std::abs(std::round(place_m * scale) / scale - place_m) < 0.0005;
        });
        if (exact) return decimals;
    }
    return 3;
}

// The line to be read aloud.
std::string headline(const storage::StudyDescription& study, const storage::RecommendationRecord& r) {
    const std::string use = "Use " + sensors(r.sensor_count) + ", " +
                            place_words(study, study.sensor_sets[r.set_index].nodes) + ". ";
    const std::string error = with_digits(r.error_N, r.error_N < 0.0995 ? 3 : 2) + " N.";
    if (r.scope == "minimax_regret") {
        return use +
               "In every motion regime the tension error exceeds that of the regime's best choice by at most " +
               error;
    }
    return use + "Expected tension error: " + error;
}

std::string scope_words(const storage::RecommendationRecord& r) {
    if (r.scope == "minimax_regret") return "all motion regimes together (minimax regret)";
    if (r.scope == "duty_cycle") return "the duty cycle";
    if (r.regime == "mass") return "motion of the entire cable";
    if (r.regime == "partial_proximal") return "motion of the motor side only";
    if (r.regime == "partial_distal") return "motion of the load side only";
    return "motion of both sides with the middle at rest";
}

// The paper's name of the set, if it has one. Several families can share a set; the plainest name wins.
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

std::string use_words(const storage::StudyDescription& study, const storage::RecommendationRecord& r,
                      bool mount) {
    const auto method = std::find_if(study.fusion_methods.begin(), study.fusion_methods.end(),
                                     [&](const auto& m) { return m.method == r.method; });
    const std::vector<int>& nodes = study.sensor_sets[r.set_index].nodes;
    std::vector<std::string> numbers;
    for (const int node : nodes) numbers.push_back(std::to_string(node));
    return "This holds for " + scope_words(r) + " with sensor noise " +
           study.noise_levels[r.noise_index].label + ". " + (mount ? "Mount the " : "The ") +
           (nodes.size() == 1 ? "sensor at node " : "sensors at nodes ") + listed(numbers) +
           layout_words(study, r.set_index) + (mount ? " and fuse the readings by " : " would be fused by ") +
           method->title + ". The 95% interval of the " + (r.scope == "minimax_regret" ? "excess" : "error") +
           " is " + with_digits(r.interval_low_N, 3) + " to " + newtons(r.interval_high_N) + ".";
}

// The draws that chose the best of many make it look better than it is.
std::string optimism_words(const storage::RecommendationRecord& r) {
    const double optimism_N = r.error_N - searched_error_N(r);
    const std::string text = "Re-estimated on independent draws; the search's own draws ";
    if (std::abs(optimism_N) < smallest_shown_N) return text + "gave the same error to 0.001 N.";
    return text + (optimism_N > 0.0 ? "were optimistic by " : "were pessimistic by ") +
           newtons(std::abs(optimism_N)) + ".";
}

std::string gain_words(const storage::RecommendationRecord& r, double worthwhile_gain_N) {
    const auto next = std::find_if(r.counts.begin(), r.counts.end(),
                                   [&](const auto& count) { return count.sensor_count > r.sensor_count; });
    if (next == r.counts.end()) return "No larger number of sensors was studied.";
    const double gain_N = searched_error_N(r) - next->error_N;
    const int added = next->sensor_count - r.sensor_count;
    const std::string more = added == 1 ? "One more sensor" : std::to_string(added) + " more sensors";
    const std::string objective = r.scope == "minimax_regret" ? "excess" : "error";
    if (gain_N < smallest_shown_N) return more + " would not lower the " + objective + ".";
    const std::string each = added == 1 ? "" : ", " + newtons(gain_N / added) + " for each";
    return more + " would lower the " + objective + " by " + newtons(gain_N) + each +
           " (threshold for adding a sensor: " + newtons(worthwhile_gain_N) + ").";
}

// Where the recommended number of sensors is not better than none, but a larger one is.
std::string better_count_words(const storage::RecommendationRecord& r, double none_N) {
    const auto better = std::find_if(r.counts.begin(), r.counts.end(), [&](const auto& count) {
        return count.sensor_count > r.sensor_count && count.interval_high_N < none_N;
    });
    if (better == r.counts.end()) return " No studied number of sensors is.";
    return " With " + sensors(better->sensor_count) + " it would be " + newtons(better->error_N) +
           ", but each adds less than the threshold.";
}

// How many sets of `chosen` of `nodes` nodes there are.
double possible_layouts(int nodes, int chosen) {
    double sets = 1.0;
    for (int k = 0; k < chosen; ++k) sets = sets * (nodes - k) / (k + 1);
    return std::round(sets);
}

// Which choices the recommended one was compared with, by which test, and what the test found.
std::string alternative_words(const storage::StudyDescription& study,
                              const storage::RecommendationRecord& r) {
    std::set<int> layouts;
    int methods = 0;
    for (const storage::RecommendationAlternativeRecord& other : r.alternatives) {
        if (other.set_index == r.set_index) {
            ++methods;
        } else {
            layouts.insert(other.set_index);
        }
    }
    const auto compared =
        std::count_if(study.sensor_sets.begin(), study.sensor_sets.end(),
                      [&](const auto& set) { return static_cast<int>(set.nodes.size()) == r.sensor_count; });
    const auto fusion_methods = std::count_if(study.fusion_methods.begin(), study.fusion_methods.end(),
                                              [](const auto& m) { return m.knowledge != "direction_known"; });
    const auto comparisons = compared * fusion_methods - 1;
    if (comparisons < 1) return "No other choice with " + sensors(r.sensor_count) + " was compared.";
    const double possible = possible_layouts(study.study.segments + 1, r.sensor_count);
    std::string text = "The study compared " + std::to_string(compared) + " of the " +
                       with_digits(possible, 0) + (possible == 1.0 ? " layout" : " layouts") + " with " +
                       sensors(r.sensor_count) + ": ";
    if (compared == 1) {
        text += methods > 0 ? "this one" : "this one, which is worse with every other fusion method";
    } else if (layouts.empty()) {
        text += compared == 2 ? "the other is worse" : "all others are worse";
    } else if (compared == 2) {
        text += "the other is not significantly worse";
    } else {
        text += std::to_string(layouts.size()) + " of the others " + (layouts.size() == 1 ? "is" : "are") +
                " not significantly worse";
    }
    if (methods > 0) {
        text += "; with the recommended layout, " + std::to_string(methods) + " other fusion " +
                (methods == 1 ? "method is" : "methods are") + " not significantly worse";
    }
    return text + " (paired t test on the study's draws at the 5% level, Bonferroni-corrected over the " +
           std::to_string(comparisons) + (comparisons == 1 ? " other choice" : " other choices") +
           " of layout and fusion method with as many sensors).";
}

}  // namespace

std::string place_words(const storage::StudyDescription& study, const std::vector<int>& nodes) {
    const std::vector<double> position_m = node_positions_m(study);
    std::vector<double> chosen_m;
    for (const int node : nodes) {
        if (node < 1 || node > static_cast<int>(position_m.size()))
            throw storage::Error("A recommendation names node " + std::to_string(node) +
                                 ", which the cable of the study does not have. The file is damaged; "
                                 "`capstan doctor` examines it.");
        chosen_m.push_back(position_m[static_cast<std::size_t>(node - 1)]);
    }
    const int decimals = place_decimals(chosen_m);
    std::vector<std::string> places;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        std::string place = with_digits(chosen_m[k], decimals) + " m";
        if (nodes[k] == 1) place += " (the motor end)";
        if (nodes[k] == static_cast<int>(position_m.size())) place += " (the load end)";
        places.push_back(std::move(place));
    }
    return "at " + listed(places);
}

std::string recommendation_sentence(const storage::StudyDescription& study,
                                    const storage::RecommendationRecord& r,
                                    const RecommendationPolicy& policy) {
    const std::optional<double> none_N = no_sensor_error_N(policy.no_sensor_N, r);
    const bool is_better = !none_N || beats_no_sensor(r, *none_N);
    std::string first = headline(study, r);
    if (!is_better)
        first = "Use no sensor: the " +
                std::string(r.scope == "minimax_regret" ? "largest excess" : "expected tension error") +
                " without any is " + newtons(*none_N) +
                ", and the sensors that the draws chose are not better: " + newtons(r.error_N) + " with " +
                sensors(r.sensor_count) + ", " + place_words(study, study.sensor_sets[r.set_index].nodes) +
                "." + better_count_words(r, *none_N);
    else if (none_N)
        first += " Without any sensor it is " + newtons(*none_N) + ".";
    return first + " " + use_words(study, r, is_better) + " " + optimism_words(r) + " " +
           gain_words(r, policy.worthwhile_gain_N) + " " + alternative_words(study, r);
}

}  // namespace capstan
