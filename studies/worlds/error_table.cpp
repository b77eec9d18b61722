#include "capstan/worlds/error_table.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/cable_cut.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/parallel_for.h"
#include "capstan/worlds/sensor_places.h"
#include "capstan/worlds/straight_pieces.h"

namespace capstan {

namespace {

// A task draws its world once; with this many questions to the filter that costs nothing beside them.
constexpr std::size_t questions_at_once = 32;
// Tasks whose entries are kept together, twice as many while they take less than so long: progress and
// stopping come no more often.
constexpr std::size_t fewest_tasks_at_once = 2;
constexpr std::size_t max_tasks_at_once = 32;
constexpr double tasks_at_once_s = 1.0;

constexpr std::string_view condition_names[] = {
    "as_stated",     "friction_known", "wrap_known",   "stiffness_known", "pretension_known",
    "sensors_known", "half_width",     "double_width", "wider_worlds",    "finer_grid",
    "finest_grid",   "paper_mean",     "paper_mean_r", "paper_w_mean",    "paper_w_mean_r"};
static_assert(std::size(condition_names) == conditions);

// All of the stated widths times `ratio`.
void widen(StudyPlan& plan, double ratio) {
    Uncertainty& unknown = plan.uncertainty;
    for (double* width :
         {&unknown.friction_fraction, &unknown.wrap_fraction, &unknown.stiffness_fraction,
          &unknown.pretension_fraction, &unknown.far_end_range_m, &plan.truth.friction_fraction,
          &plan.truth.stiffness_fraction, &plan.truth.pretension_fraction})
        *width *= ratio;
    for (std::vector<double>& deviations : plan.truth.effect_deviations)
        for (double& deviation : deviations) deviation *= ratio;
}

StudyPlan plan_under(Condition condition, StudyPlan plan) {
    Uncertainty& unknown = plan.uncertainty;
    if (unknown.far_end_range_m <= 0.0) unknown.far_end_range_m = std::abs(plan.motion.distal.amplitude);
    if (condition == Condition::half_width) widen(plan, 0.5);
    if (condition == Condition::double_width) widen(plan, 2.0);
    if (condition == Condition::wider_worlds) unknown.worlds_ratio *= 2.0;
    return plan;
}

// Into how many each segment is cut.
int pieces_under(Condition condition) {
    if (condition == Condition::finer_grid) return 2;
    if (condition == Condition::finest_grid) return 4;
    return 1;
}

// What the estimator believes in a world in which one thing is known.
CableBelief belief_under(Condition condition, CableBelief belief, const World& world) {
    for (std::size_t cable = 0; cable < belief.expected.size(); ++cable) {
        CableFactors& expected = belief.expected[cable];
        const CableFactors& truth = world.factors[cable];
        if (condition == Condition::friction_known)
            expected.log_friction = truth.log_friction + world.log_friction_ratio;
        if (condition == Condition::wrap_known) expected.log_wrap = truth.log_wrap;
        if (condition == Condition::stiffness_known)
            expected.log_stiffness = truth.log_stiffness + world.log_stiffness_ratio;
        if (condition == Condition::pretension_known)
            expected.log_pretension = truth.log_pretension + world.log_pretension_ratio;
    }
    if (condition == Condition::friction_known) belief.uncertainty.friction = 0.0;
    if (condition == Condition::wrap_known) belief.uncertainty.wrap = 0.0;
    if (condition == Condition::stiffness_known) belief.uncertainty.stiffness = 0.0;
    if (condition == Condition::pretension_known) belief.uncertainty.pretension = 0.0;
    return belief;
}

}  // namespace

const FusionMethod* paper_method(Condition condition) {
    switch (condition) {
        case Condition::paper_mean:
            return &mean_method;
        case Condition::paper_mean_r:
            return &mean_r_method;
        case Condition::paper_w_mean:
            return &weighted_mean_method;
        case Condition::paper_w_mean_r:
            return &weighted_mean_r_method;
        case Condition::as_stated:
        case Condition::friction_known:
        case Condition::wrap_known:
        case Condition::stiffness_known:
        case Condition::pretension_known:
        case Condition::sensors_known:
        case Condition::half_width:
        case Condition::double_width:
        case Condition::wider_worlds:
        case Condition::finer_grid:
        case Condition::finest_grid:
            break;
    }
    return nullptr;
}

std::string_view name_of(Condition condition) {
    return condition_names[static_cast<std::size_t>(condition)];
}

std::optional<Condition> find_condition(std::string_view name) {
    const auto* found = std::find(std::begin(condition_names), std::end(condition_names), name);
    if (found == std::end(condition_names)) return std::nullopt;
    return static_cast<Condition>(found - std::begin(condition_names));
}

ErrorTable::ErrorTable(const StudyPlan& plan, TableOptions options)
    : plan_(plan), options_(std::move(options)) {
    questions_.resize(conditions);
    rows_.resize(conditions);
    candidates_ = candidates_of(plan_, question_of(Condition::as_stated).offers);
    first_alike_ = first_alike(plan_, offers());
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        const int number = static_cast<int>(k);
        if (candidates_[k].is_bound) bound_ = number;
        number_of_.insert({candidates_[k].sensors, number});
    }
    for (auto& rows : rows_) rows.resize(candidates_.size());
}

int ErrorTable::candidate_of(const std::vector<int>& sensors) {
    const auto [at, is_new] = number_of_.insert({sensors, static_cast<int>(candidates_.size())});
    if (!is_new) return at->second;
    candidates_.push_back({sensors, {}, price_of(sensors, offers())});
    for (auto& rows : rows_) rows.resize(std::max(rows.size(), candidates_.size()));
    if (options_.keep_candidate) options_.keep_candidate(at->second, candidates_.back());
    return at->second;
}

const WorldQuestion& ErrorTable::question_of(Condition condition) {
    auto& question = questions_[static_cast<std::size_t>(condition)];
    if (!question) {
        StudyPlan plan = plan_under(condition, plan_);
        if (condition == Condition::sensors_known) plan.sensors = calibrated_sensors(plan);
        question = std::make_unique<WorldQuestion>(world_question(plan, pieces_under(condition)));
        // The paper's methods average over patterns of all segments, and effects act along straight conduit.
        if (paper_method(condition) == nullptr && !plan_.truth.has_effects())
            question->cable = UncertainCable(with_straight_joined(question->cable.nominal()));
        // The offers stay where they are, whatever the grid.
        question->offers = condition == Condition::sensors_known ? sensor_offers(plan) : sensor_offers(plan_);
    }
    return *question;
}

void ErrorTable::take(const TableEntry& entry) {
    const std::size_t known = candidates_.size() + (grows() ? max_candidates : 0);
    const auto candidate = static_cast<std::size_t>(entry.candidate);
    if (entry.candidate < 0 || candidate >= known || entry.world < 0) return;
    auto& rows = rows_[static_cast<std::size_t>(entry.condition)];
    if (candidate >= rows.size()) rows.resize(candidate + 1);
    Row& row = rows[candidate];
    if (static_cast<int>(row.size()) <= entry.world) row.resize(static_cast<std::size_t>(entry.world) + 1);
    row[static_cast<std::size_t>(entry.world)] = entry.error;
}

void ErrorTable::offer(const TableEntry& entry) {
    offered_.insert({{entry.condition, entry.candidate, entry.world}, entry.error});
}

// What the estimator is asked: sensors whose readings are the same stand for one another in the ensemble
// filter; the paper's methods take each at its own place.
std::vector<int> ErrorTable::sensors_asked(Condition condition, int candidate) const {
    std::vector<int> sensors = candidates_[static_cast<std::size_t>(candidate)].sensors;
    if (paper_method(condition) != nullptr) return sensors;
    for (int& sensor : sensors) sensor = first_alike_[static_cast<std::size_t>(sensor)];
    return sensors;
}

// What is missing, candidates with the same question side by side.
std::vector<ErrorTable::Task> ErrorTable::tasks(Condition condition, std::span<const int> candidates,
                                                int first, int last, int stride) const {
    std::map<std::vector<int>, std::vector<int>> by_question;
    for (const int candidate : candidates)
        by_question[sensors_asked(condition, candidate)].push_back(candidate);
    std::vector<Task> tasks;
    for (int world = first; world < last; world += stride) {
        Task task{world, {}};
        for (const auto& [sensors, alike] : by_question) {
            const std::size_t before = task.candidates.size();
            std::copy_if(alike.begin(), alike.end(), std::back_inserter(task.candidates),
                         [&](int candidate) { return !has(condition, candidate, world); });
            if (task.candidates.size() > before) ++task.questions;
            if (task.questions < questions_at_once) continue;
            tasks.push_back(std::move(task));
            task = {world, {}};
        }
        if (!task.candidates.empty()) tasks.push_back(std::move(task));
    }
    return tasks;
}

void ErrorTable::fill(Condition condition, std::span<const int> candidates, int first, int last,
                      std::string_view activity, int stride) {
    const std::vector<Task> tasks = this->tasks(condition, candidates, first, last, stride);
    double trials = 0.0;
    for (const Task& task : tasks) trials += static_cast<double>(task.candidates.size());
    if (tasks.empty()) return;
    const WorldQuestion& question = question_of(condition);
    if (const FusionMethod* paper = paper_method(condition); paper != nullptr && paper->uses_weights)
        weigh(condition, candidates);
    std::size_t done = 0;
    std::size_t at_once = fewest_tasks_at_once;
    for (std::size_t from = 0, count = 0; from < tasks.size(); from += count) {
        if (options_.stop != nullptr && *options_.stop) throw TableStopped{};
        const double begin_s = wall_time_s();
        count = std::min(at_once, tasks.size() - from);
        std::vector<std::vector<TableEntry>> results(count);
        parallel_for_each_index(static_cast<int>(count), options_.jobs, [&](int k) {
            const auto at = static_cast<std::size_t>(k);
            results[at] = run(condition, question, tasks[from + at]);
        });
        std::vector<TableEntry> entries;
        for (auto& result : results) entries.insert(entries.end(), result.begin(), result.end());
        for (const TableEntry& entry : entries) take(entry);
        if (options_.keep) options_.keep(entries);
        done += entries.size();
        if (options_.on_progress) options_.on_progress({activity, static_cast<double>(done), trials});
        if (wall_time_s() - begin_s < tasks_at_once_s) at_once = std::min(2 * at_once, max_tasks_at_once);
    }
}

// The weights of the candidates' tension sensors, as the W methods need them.
void ErrorTable::weigh(Condition condition, std::span<const int> candidates) {
    const WorldQuestion& question = question_of(condition);
    paper_weight_.resize(question.offers.size(), 0.0);
    std::vector<int> missing;
    for (const int candidate : candidates) {
        for (const int sensor : candidates_[static_cast<std::size_t>(candidate)].sensors) {
            const bool is_weighed = paper_weight_[static_cast<std::size_t>(sensor)] > 0.0;
            if (!is_weighed && measures_tension(question.offers[static_cast<std::size_t>(sensor)].kind))
                missing.push_back(sensor);
        }
    }
    parallel_for_each_index(static_cast<int>(missing.size()), options_.jobs, [&](int k) {
        const int sensor = missing[static_cast<std::size_t>(k)];
        paper_weight_[static_cast<std::size_t>(sensor)] = paper_weight(question, sensor);
    });
}

std::vector<TableEntry> ErrorTable::run(Condition condition, const WorldQuestion& question,
                                        const Task& task) const {
    std::vector<TableEntry> entries;
    std::vector<int> candidates;
    for (const int candidate : task.candidates) {
        const auto found = offered_.find({condition, candidate, task.world});
        if (found == offered_.end()) {
            candidates.push_back(candidate);
        } else {
            entries.push_back({condition, candidate, task.world, found->second});
        }
    }
    if (candidates.empty()) return entries;
    const World world = draw_world(question, static_cast<std::uint32_t>(task.world));
    const EnsembleDraws draws = ensemble_draws(question, static_cast<std::uint32_t>(task.world));
    const CableBelief belief = belief_under(condition, question.belief, world);
    const FusionMethod* paper = paper_method(condition);
    std::vector<int> asked;
    std::optional<WorldError> answer;
    for (const int candidate : candidates) {
        const std::vector<int> sensors = sensors_asked(condition, candidate);
        if (!answer || sensors != asked)
            answer = paper != nullptr ? paper_error(question, world, sensors, *paper, paper_weight_)
                                      : filter_error(question, belief, world, draws, sensors);
        asked = sensors;
        entries.push_back({condition, candidate, task.world, *answer});
    }
    return entries;
}

bool ErrorTable::has(Condition condition, int candidate, int world) const {
    const Row& row = rows_[static_cast<std::size_t>(condition)][static_cast<std::size_t>(candidate)];
    return world < static_cast<int>(row.size()) && row[static_cast<std::size_t>(world)].has_value();
}

std::size_t ErrorTable::entries(Condition condition, int last) const {
    std::size_t count = 0;
    for (int candidate = 0; candidate < static_cast<int>(candidates_.size()); ++candidate)
        for (int world = 0; world < last; ++world) count += has(condition, candidate, world) ? 1 : 0;
    return count;
}

const WorldError& ErrorTable::at(Condition condition, int candidate, int world) const {
    const Row& row = rows_[static_cast<std::size_t>(condition)][static_cast<std::size_t>(candidate)];
    return row.at(static_cast<std::size_t>(world)).value();
}

}  // namespace capstan
