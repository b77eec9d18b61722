// The size and the cost of work, before it starts.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/answers/study_answers.h"
#include "capstan/platform/progress.h"
#include "capstan/worlds/candidate.h"
#include "capstan/worlds/sensor_places.h"

namespace capstan::answers {

using reports::Data;

namespace {

// The size of a plan.
struct PlanSize {
    int nodes = 0;
    std::size_t scenarios = 0;
    std::size_t noise_levels = 0;
    std::size_t sensor_sets = 0;
    std::size_t methods = 0;
    std::size_t cells = 0;   ///< 0: over worlds
    bool is_greedy = false;  ///< the search tries more sets than `sensor_sets`
};

PlanSize size_of(const StudyPlan& plan) {
    PlanSize size;
    size.nodes = plan.transmission.cable.segments + 1;
    if (plan.uncertainty.is_stated) {
        const std::vector<Candidate> candidates = candidates_of(plan, sensor_offers(plan));
        size.is_greedy = candidates.back().is_bound;
        size.sensor_sets =
            candidates.size() - (size.is_greedy ? 2 : 1);  // without the empty one and the bound
        return size;
    }
    for (const RegimeInstants& regime : plan.regimes) size.scenarios += regime.samples.size();
    std::set<std::vector<int>> sets;
    for (const std::string& family : plan.layout_families) {
        for (const int count : plan.sensor_counts) {
            for (const Layout& layout : find_layout_family(family)->layouts(count, size.nodes))
                sets.insert(layout.nodes);
        }
    }
    for (const auto& nodes : plan.explicit_layouts) sets.insert(explicit_layout(nodes).nodes);
    size.noise_levels = plan.noise_levels.size();
    size.sensor_sets = sets.size();
    size.methods = plan.fusion_methods.size();
    size.cells = size.scenarios * size.noise_levels * size.sensor_sets * size.methods;
    return size;
}

// The total of all studies of a sweep; nodes and sensor sets are those of the largest.
PlanSize size_of(const std::vector<StudyPlan>& studies) {
    PlanSize total;
    for (const StudyPlan& study : studies) {
        const PlanSize size = size_of(study);
        total.nodes = std::max(total.nodes, size.nodes);
        total.sensor_sets = std::max(total.sensor_sets, size.sensor_sets);
        total.is_greedy = total.is_greedy || size.is_greedy;
        total.scenarios += size.scenarios;
        total.noise_levels = size.noise_levels;
        total.methods = size.methods;
        total.cells += size.cells;
    }
    return total;
}

}  // namespace

std::string plan_size_text(const std::string& file, const StudyPlan& plan,
                           const std::vector<StudyPlan>& studies) {
    const PlanSize size = size_of(studies);
    const std::string sweep =
        studies.size() > 1 ? fmt::format("  a sweep of {} studies, together:\n", studies.size()) : "";
    const std::string conduit =
        plan.transmission.conduit_note.empty() ? "" : "  conduit: " + plan.transmission.conduit_note + "\n";
    if (plan.uncertainty.is_stated)
        return fmt::format(
            "{}: ok\n{}{}  {} nodes, {} of sensors{}, {} worlds to choose and as many to judge\n", file,
            sweep, conduit, size.nodes, counted(size.sensor_sets, "set"),
            size.is_greedy ? " and those of a greedy search" : "", plan.repetitions);
    return fmt::format("{}: ok\n{}{}  {} nodes, {}, {}, {}, {}: {} of {} repetitions\n", file, sweep, conduit,
                       size.nodes, counted(size.scenarios, "instant"),
                       counted(size.noise_levels, "noise level"), counted(size.sensor_sets, "sensor set"),
                       counted(size.methods, "method"), counted(size.cells, "cell"), plan.repetitions);
}

Data plan_size_data(const StudyPlan& plan, const std::vector<StudyPlan>& studies) {
    const PlanSize size = size_of(studies);
    if (plan.uncertainty.is_stated)
        return {{"ok", true},
                {"name", plan.name},
                {"studies", studies.size()},
                {"conduit", plan.transmission.conduit_note},
                {"nodes", size.nodes},
                {"sensor_sets", size.sensor_sets},
                {"greedy", size.is_greedy},
                {"worlds", plan.repetitions}};
    return {{"ok", true},
            {"name", plan.name},
            {"studies", studies.size()},
            {"conduit", plan.transmission.conduit_note},
            {"nodes", size.nodes},
            {"scenarios", size.scenarios},
            {"noise_levels", size.noise_levels},
            {"sensor_sets", size.sensor_sets},
            {"methods", size.methods},
            {"cells", size.cells},
            {"repetitions", plan.repetitions}};
}

reports::Answer cost_answer(const std::string& name, const StudyCost& cost,
                            const std::vector<StudyPlan>& plans, int shards) {
    const double sharded_s = cost.processor_s_with(plans, shards);
    constexpr double hour_s = 3600.0;
    reports::Answer answer{.id = "cost",
                           .kind = "Estimated cost of a study",
                           .title = name,
                           .headline = fmt::format("one run takes {:.3g} core-hours on this machine.",
                                                   cost.processor_s / hour_s)};
    answer.values = {{"name", name},
                     {"studies", cost.studies},
                     {"parts", cost.parts},
                     {"cells", cost.cells},
                     {"repetitions", cost.repetitions},
                     {"readings", cost.readings},
                     {"one_run_core_hours", cost.processor_s / hour_s},
                     {"shards", shards},
                     {"core_hours", sharded_s / hour_s},
                     {"shard_s", sharded_s / shards},
                     {"shard_preparation_s", cost.shard_preparation_s},
                     {"parts_solved_again", parts_solved_again(plans, shards)},
                     {"median_half_width_N", cost.median_half_width_N},
                     {"largest_half_width_N", cost.largest_half_width_N},
                     {"pilot_parts", cost.pilot_parts},
                     {"pilot_repetitions", cost.pilot_repetitions}};
    Data rows = Data::list();
    const auto add = [&](const char* quantity, Data value, const char* unit) {
        rows.push_back({{"quantity", quantity}, {"value", std::move(value)}, {"unit", unit}});
    };
    add("studies", cost.studies, "");
    add("parts (instants times noise levels): the largest number of shards", cost.parts, "");
    add("cells", cost.cells, "");
    add("repetitions of each", cost.repetitions, "");
    add("readings", cost.readings, "");
    add("one run", cost.processor_s / hour_s, "core-hours");
    add("number of shards", shards, "");
    add("all shards together", sharded_s / hour_s, "core-hours");
    add("each shard", sharded_s / shards, "s");
    add("of it preparation", cost.shard_preparation_s, "s");
    add("half width of a cell's 95% interval, median", cost.median_half_width_N, "N");
    add("half width of a cell's 95% interval, largest", cost.largest_half_width_N, "N");
    answer.sections = {
        {.id = "cost",
         .heading = "Size and cost",
         .tables = {{"cost",
                     "",
                     {{"quantity", "quantity"}, {"value", "value", "", ".3g"}, {"unit", "unit"}},
                     rows}},
         .note = fmt::format("Predicted from {} parts, timed with {} repetitions each.", cost.pilot_parts,
                             cost.pilot_repetitions)}};
    return answer;
}

reports::Answer diagnosis_cost_answer(const std::string& recording,
                                      const model_comparison::DiagnosisCost& cost) {
    reports::Answer answer{
        .id = "diagnosis_cost",
        .kind = "Estimated cost of a diagnosis",
        .title = recording,
        .headline = fmt::format("a diagnosis takes {} on this machine, depending on what it finds.",
                                duration_range_words(cost.min_seconds, cost.max_seconds))};
    answer.values = {{"recording", recording},
                     {"runs", cost.runs},
                     {"samples", cost.samples},
                     {"causes", cost.causes},
                     {"simulation_s", cost.simulation_s},
                     {"min_seconds", cost.min_seconds},
                     {"max_seconds", cost.max_seconds}};
    return answer;
}

}  // namespace capstan::answers
