#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "capstan/worlds/candidate.h"
#include "capstan/worlds/world_trial.h"

namespace capstan {

/// Under what a candidate is tried, beside its sensors.
enum class Condition {
    as_stated,       ///< worlds and estimator as the configuration says
    friction_known,  ///< the estimator is told the world's friction
    wrap_known,      ///< and so on: what calibrating would tell it
    stiffness_known,
    pretension_known,
    sensors_known,   ///< zeros and gains
    half_width,      ///< worlds and estimator with half of the stated uncertainty
    double_width,    ///< with twice of it
    wider_worlds,    ///< worlds twice as uncertain as the estimator is told
    finer_grid,      ///< twice the segments
    finest_grid,     ///< four times the segments
    paper_mean,      ///< the paper's Mean over time in place of the ensemble filter
    paper_mean_r,    ///< the paper's Mean-R
    paper_w_mean,    ///< the paper's W Mean
    paper_w_mean_r,  ///< the paper's W Mean-R
};
inline constexpr int conditions = static_cast<int>(Condition::paper_w_mean_r) + 1;
/// The method of the paper that stands in place of the ensemble filter; null where none does.
const FusionMethod* paper_method(Condition condition);
std::string_view name_of(Condition condition);
std::optional<Condition> find_condition(std::string_view name);

/// The error of one candidate in one world.
struct TableEntry {
    Condition condition = Condition::as_stated;
    int candidate = 0;
    int world = 0;
    WorldError error;
};

/// How far a study is.
struct TableProgress {
    std::string_view activity;
    double done = 0.0;   ///< trials
    double total = 0.0;  ///< trials, as far as known
};

struct TableOptions {
    int jobs = 0;                                                 ///< threads; 0: all processors
    std::function<void(std::span<const TableEntry>)> keep{};      ///< stores new entries, in order
    std::function<void(int, const Candidate&)> keep_candidate{};  ///< stores one that a search has added
    std::function<void(const TableProgress&)> on_progress{};
    const std::atomic<bool>* stop = nullptr;
};

/// Thrown where `stop` was set; what was computed has been kept.
struct TableStopped {};

/// The one table of errors, candidate x condition x world, filled as it is asked. An entry depends on nothing
/// but its address, so it does not matter which were there before, or who computed them. Sets of sensors
/// whose readings are the same (first_alike()) are one question to the ensemble filter: it answers with the
/// first place of each straight piece, for all of them.
class ErrorTable {
  public:
    ErrorTable(const StudyPlan& plan, TableOptions options);

    const std::vector<SensorOffer>& offers() const { return questions_[0]->offers; }
    const std::vector<Candidate>& candidates() const { return candidates_; }
    const StudyPlan& plan() const { return plan_; }

    /// The number of this set of sensors (rising); a new one at the end if it is not there yet.
    int candidate_of(const std::vector<int>& sensors);

    /// Takes over an entry that was computed before. An entry of a candidate that is not there yet is used
    /// when the candidate is added; in a table without a greedy search it is ignored.
    void take(const TableEntry& entry);

    /// An entry that another run computed: fill() takes and keeps it instead of computing it.
    void offer(const TableEntry& entry);

    /// Computes what is missing of these candidates in worlds `first` to `last` - 1, every `stride`th.
    void fill(Condition condition, std::span<const int> candidates, int first, int last,
              std::string_view activity, int stride = 1);

    /// Whether the sensors of two candidates read the same in every world.
    bool are_alike(int candidate, int other) const {
        return sensors_asked(Condition::as_stated, candidate) == sensors_asked(Condition::as_stated, other);
    }
    bool has(Condition condition, int candidate, int world) const;
    /// How many entries there are of the worlds before `last`.
    std::size_t entries(Condition condition, int last) const;
    /// Whether a greedy search adds candidates, because all sets are too many.
    bool grows() const { return bound_.has_value(); }
    /// All usable sensors together; only of a table that grows.
    std::optional<int> bound() const { return bound_; }
    /// Must be filled.
    const WorldError& at(Condition condition, int candidate, int world) const;

  private:
    struct Task {
        int world = 0;
        std::vector<int> candidates;
        std::size_t questions = 0;
    };
    using Row = std::vector<std::optional<WorldError>>;  // worlds

    const WorldQuestion& question_of(Condition condition);
    std::vector<int> sensors_asked(Condition condition, int candidate) const;
    std::vector<Task> tasks(Condition condition, std::span<const int> candidates, int first, int last,
                            int stride) const;
    void weigh(Condition condition, std::span<const int> candidates);
    std::vector<TableEntry> run(Condition condition, const WorldQuestion& question, const Task& task) const;

    StudyPlan plan_;
    TableOptions options_;
    std::vector<Candidate> candidates_;
    std::vector<int> first_alike_;  // offers
    std::optional<int> bound_;
    std::map<std::vector<int>, int> number_of_;              // sensors: candidate
    std::vector<double> paper_weight_;                       // offers; 0: not needed yet
    std::vector<std::unique_ptr<WorldQuestion>> questions_;  // conditions
    std::vector<std::vector<Row>> rows_;                     // conditions x candidates
    std::map<std::tuple<Condition, int, int>, WorldError> offered_;
};

}  // namespace capstan
