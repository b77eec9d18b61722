#include "capstan/paper/placement_comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "capstan/storage/report_queries.h"
#include "capstan/storage/study_store.h"

namespace capstan::paper {

namespace {

const std::vector<std::string> all_families = {"even", "distal", "both"};
const std::vector<std::string> unknown_methods = {"mean", "mean_r", "w_mean", "w_mean_r"};

// A number of ours; empty if the study does not hold what it is made of.
struct Ours {
    double value_N = 0.0;
    double standard_error_N = 0.0;
};
using MaybeOurs = std::optional<Ours>;

struct Counts {
    int first = 1;
    int last = 1;
};

// Errors of a study at one noise level, by regime, family, count and method.
class ErrorsByLayout {
  public:
    explicit ErrorsByLayout(const std::vector<storage::LayoutErrorSummary>& rows) {
        for (const storage::LayoutErrorSummary& row : rows) {
            errors_[{row.regime, row.family, row.sensor_count, row.method}] = {row.mean_abs_error_N,
                                                                               row.standard_error_N};
            largest_count_ = std::max(largest_count_, row.sensor_count);
        }
    }

    // One sensor of Even and Both in mass motion, whatever the method.
    void put_one_sensor(const Ours& error) {
        for (const char* family : {"even", "both"}) {
            for (const std::string& method : unknown_methods) errors_[{"mass", family, 1, method}] = error;
        }
    }

    int largest_count() const { return largest_count_; }
    Counts all_counts() const { return {1, largest_count_}; }

    // The plain average over families, counts and methods; empty if one of them is missing.
    MaybeOurs average(const std::string& regime, const std::vector<std::string>& families, Counts counts,
                      const std::vector<std::string>& methods) const {
        Ours sum;
        int terms = 0;
        for (const std::string& family : families) {
            for (int count = counts.first; count <= counts.last; ++count) {
                for (const std::string& method : methods) {
                    const auto found = errors_.find({regime, family, count, method});
                    if (found == errors_.end()) return std::nullopt;
                    sum.value_N += found->second.value_N;
                    sum.standard_error_N += found->second.standard_error_N;
                    ++terms;
                }
            }
        }
        if (terms == 0) return std::nullopt;
        return Ours{sum.value_N / terms, sum.standard_error_N / terms};
    }

  private:
    std::map<std::tuple<std::string, std::string, int, std::string>, Ours> errors_;
    int largest_count_ = 0;
};

MaybeOurs difference(const MaybeOurs& a, const MaybeOurs& b) {
    if (!a || !b) return std::nullopt;
    return Ours{a->value_N - b->value_N, std::hypot(a->standard_error_N, b->standard_error_N)};
}

// The largest difference between layout families at the same count.
MaybeOurs largest_spread(const ErrorsByLayout& errors, const std::string& regime, const std::string& method) {
    MaybeOurs largest;
    for (int count = 1; count <= errors.largest_count(); ++count) {
        std::vector<Ours> at_count;
        for (const std::string& family : all_families) {
            const MaybeOurs error = errors.average(regime, {family}, {count, count}, {method});
            if (!error) return std::nullopt;
            at_count.push_back(*error);
        }
        const auto [low, high] =
            std::minmax_element(at_count.begin(), at_count.end(),
                                [](const Ours& a, const Ours& b) { return a.value_N < b.value_N; });
        const MaybeOurs spread = difference(*high, *low);
        if (!largest || spread->value_N > largest->value_N) largest = spread;
    }
    return largest;
}

// Mean error of one sensor's estimate, direction unknown, over the instants of mass motion.
MaybeOurs single_sensor(storage::Database& database, std::int64_t study_id,
                        const storage::StudyDescription& study, int sensor_node) {
    Ours sum;
    int instants = 0;
    for (int s = 0; s < static_cast<int>(study.scenarios.size()); ++s) {
        if (study.scenarios[s].regime != "mass") continue;
        for (const auto& sensor : storage::read_single_sensor(database, study_id, s, 0)) {
            if (sensor.knowledge != "direction_unknown" || sensor.sensor_node != sensor_node) continue;
            sum.value_N += sensor.mean_abs_error_N;
            sum.standard_error_N = std::hypot(sum.standard_error_N, sensor.standard_error_N);
            ++instants;
        }
    }
    if (instants == 0) return std::nullopt;
    return Ours{sum.value_N / instants, sum.standard_error_N / instants};
}

// Why a number of ours parts from the paper's.
struct Reason {
    std::string words;
    std::string evidence;  // "a guess", or the ablation of `paper estimation` that accounts for it

    std::string text() const { return evidence.empty() ? words : words + " (" + evidence + ")"; }
};

// A number of the paper, ours beside it, and why they part if they do.
struct Row {
    std::string quantity;
    double paper_N;
    std::string relation;
    MaybeOurs ours;
    Reason reason;
};

const Reason order_of_trial{
    "several direction patterns often verify (see the ambiguous fraction), and the paper does not say in which order "
    "they are tried: ours by Hamming distance from the previous direction",
    "ablation: farthest_first"};
const Reason instants_unknown{
    "the paper does not say which instants it used; those of the configuration were found by matching its figures",
    "ablation: other_instants"};
const Reason even_unclear{
    "at one sensor, Even and Both are averaged over both ends here; the paper does not say where that sensor is",
    "ablation: one_sensor_proximal"};
const Reason both_unclear{even_unclear.words, "ablation: one_sensor_distal"};
const Reason blocked_end{
    "the paper does not say whether an estimate may let the blocked end move; here it may not",
    "ablation: distal_side_admitted"};
const Reason unknown{"unknown", ""};
const Reason weights_sum_to_one{
    "weights that sum to one cannot give errors of the size of the tension itself; dropping sensors at rest without "
    "sharing out their weight would",
    "a guess"};

std::vector<Row> rows(storage::Database& database, std::int64_t study_id,
                      const storage::StudyDescription& study, const ErrorsByLayout& errors) {
    const int all = errors.largest_count();
    const Counts every = errors.all_counts();
    const auto mass = [&](const std::vector<std::string>& families, Counts counts,
                          const std::vector<std::string>& methods) {
        return errors.average("mass", families, counts, methods);
    };
    // The paper leaves Distal out in partial motion.
    const auto partial = [&](const std::string& method) {
        return errors.average("partial_proximal", {"even", "both"}, every, {method});
    };
    const auto gain = [&](const std::vector<std::string>& families) {
        return difference(mass(families, {1, 1}, unknown_methods),
                          mass(families, {all, all}, unknown_methods));
    };
    const auto distal_better_than = [&](const std::string& family) {
        return difference(mass({family}, every, unknown_methods), mass({"distal"}, every, unknown_methods));
    };
    return {
        {"direction known: largest difference between layouts",
         0.01,
         "<",
         largest_spread(errors, "mass", "mean_known"),
         {"too few repetitions", "a guess"}},
        {"single sensor at the proximal node", 1.6, "=", single_sensor(database, study_id, study, 1),
         instants_unknown},
        {"single sensor at the distal node", 0.37, "=",
         single_sensor(database, study_id, study, study.study.segments + 1), blocked_end},
        {"mass motion, all layouts and counts: W Mean", 0.42, "=", mass(all_families, every, {"w_mean"}),
         instants_unknown},
        {"mass motion, all layouts and counts: Mean-R", 0.47, "=", mass(all_families, every, {"mean_r"}),
         order_of_trial},
        {"mass motion, all layouts and counts: Mean", 0.49, "=", mass(all_families, every, {"mean"}),
         order_of_trial},
        {"mass motion, all layouts and counts: W Mean-R", 0.57, "=", mass(all_families, every, {"w_mean_r"}),
         order_of_trial},
        {"Distal, 2 to 5 sensors: Mean", 0.38, "=", mass({"distal"}, {2, 5}, {"mean"}), instants_unknown},
        {"Distal, 2 to 5 sensors: W Mean", 0.38, "=", mass({"distal"}, {2, 5}, {"w_mean"}), instants_unknown},
        {"Distal, 6 sensors to all: Mean", 0.33, "=", mass({"distal"}, {6, all}, {"mean"}), unknown},
        {"Distal, 6 sensors to all: W Mean", 0.35, "=", mass({"distal"}, {6, all}, {"w_mean"}),
         instants_unknown},
        {"gain from one sensor to all: Even", 0.67, "=", gain({"even"}), even_unclear},
        {"gain from one sensor to all: Distal", 0.02, "=", gain({"distal"}), unknown},
        {"gain from one sensor to all: Both", 0.37, "=", gain({"both"}), even_unclear},
        {"gain from one sensor to all: average", 0.35, "=", gain(all_families), even_unclear},
        {"Distal is better than Even by", 0.20, "=", distal_better_than("even"), even_unclear},
        {"Distal is better than Both by", 0.07, "=", distal_better_than("both"), both_unclear},
        {"partial motion, Even and Both: Mean", 0.54, "=", partial("mean"), order_of_trial},
        {"partial motion, Even and Both: Mean-R", 0.52, "=", partial("mean_r"), order_of_trial},
        {"partial motion, Even and Both: W Mean", 4.7, "=", partial("w_mean"), weights_sum_to_one},
        {"partial motion, Even and Both: W Mean-R", 5.9, "=", partial("w_mean_r"), weights_sum_to_one},
    };
}

bool agree(const Row& row) {
    const double apart_N =
        row.relation == "<" ? row.ours->value_N - row.paper_N : std::abs(row.ours->value_N - row.paper_N);
    const double slack_N = row.relation == "<" ? 0.0 : storage::paper_agreement_N;
    return apart_N <= slack_N + storage::paper_agreement_standard_errors * row.ours->standard_error_N;
}

}  // namespace

std::vector<storage::PaperComparisonRecord> compare_placement(storage::Database& database,
                                                              std::int64_t study_id) {
    return compare_placement_with(OneSensor::both_ends, database, study_id);
}

std::vector<storage::PaperComparisonRecord> compare_placement_with(OneSensor one_sensor,
                                                                   storage::Database& database,
                                                                   std::int64_t study_id) {
    const storage::StudyDescription study = storage::load_study(database, study_id);
    ErrorsByLayout errors(storage::read_errors_by_layout(database, study_id, 0));
    if (one_sensor != OneSensor::both_ends) {
        const int node = one_sensor == OneSensor::proximal_end ? 1 : study.study.segments + 1;
        if (const MaybeOurs error = single_sensor(database, study_id, study, node))
            errors.put_one_sensor(*error);
    }
    std::vector<storage::PaperComparisonRecord> records;
    for (const Row& row : rows(database, study_id, study, errors)) {
        if (!row.ours) continue;
        records.push_back({row.quantity, row.paper_N, row.ours->value_N, row.ours->standard_error_N,
                           row.relation, agree(row) ? agrees : row.reason.text()});
    }
    return records;
}

}  // namespace capstan::paper
