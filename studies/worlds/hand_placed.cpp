#include "capstan/worlds/hand_placed.h"

#include <algorithm>

#include "capstan/worlds/choice.h"
#include "capstan/worlds/set_constraints.h"
#include "capstan/worlds/stored_worlds.h"

namespace capstan {

namespace {

constexpr int one_thread = 1;  // a study may be running at the same time

}  // namespace

HandPlacer::HandPlacer(storage::Database& database, std::int64_t study_id, const StudyPlan& plan)
    : table_(complete_table(database, study_id, plan, {.jobs = one_thread})),
      answer_(choose_sensors(table_)) {}

HandPlaced HandPlacer::judge(std::vector<int> sensors) {
    const std::lock_guard lock(mutex_);
    std::sort(sensors.begin(), sensors.end());
    const int offers = static_cast<int>(table_.offers().size());
    std::vector<std::string> problems;
    if (sensors.empty()) problems.push_back("no sensor is placed; place one or more");
    if (std::adjacent_find(sensors.begin(), sensors.end()) != sensors.end())
        problems.push_back("a sensor is placed twice; name each sensor once");
    if (!sensors.empty() && (sensors.front() < 0 || sensors.back() >= offers))
        problems.push_back("sensors count from 1 to " + std::to_string(offers) + ", as on offer");
    if (!problems.empty()) throw InvalidInput(problems);
    const int set = table_.candidate_of(sensors);
    const int recommended = answer_.recommended ? answer_.best().expected.candidate : 0;
    Choice choice(table_);
    const int first = choice.worlds();
    const int last = 2 * first;
    choice.fill(Condition::as_stated, std::vector{set, recommended, 0}, first, last, "placed by hand");
    HandPlaced placed;
    placed.set = choice.candidate(set);
    placed.is_allowed = SetConstraints(table_.plan(), table_.offers()).allow(sensors);
    placed.expected = choice.expected(set);
    placed.gain_over_none = choice.paired(Condition::as_stated, 0, Condition::as_stated, set, first, last);
    placed.worse_than_recommended =
        choice.paired(Condition::as_stated, set, Condition::as_stated, recommended, first, last);
    return placed;
}

}  // namespace capstan
