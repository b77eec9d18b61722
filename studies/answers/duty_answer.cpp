#include <fmt/format.h>

#include <algorithm>

#include "capstan/answers/recording_answers.h"

namespace capstan::answers {

namespace {

using duty::MotionTimes;
using reports::Data;

Data times_data(const MotionTimes& times) {
    Data data = {{"total_s", times.total_s()}, {"still_s", times.still_s}, {"slack_s", times.slack_s}};
    Data fractions = {{"slack", times.slack_s / times.total_s()}, {"still", times.still_s / times.total_s()}};
    for (const Regime regime : all_regimes) {
        const double time_s = times.regime_s[static_cast<std::size_t>(regime)];
        data[std::string(name_of(regime)) + "_s"] = time_s;
        fractions[name_of(regime)] = time_s / times.total_s();
    }
    data["fraction"] = std::move(fractions);
    return data;
}

std::vector<reports::Column> time_columns() {
    std::vector<reports::Column> columns = {{"run", "run"}, {"total_s", "time", "s", ".1f"}};
    for (const Regime regime : all_regimes) {
        std::string title(name_of(regime));
        std::replace(title.begin(), title.end(), '_', ' ');
        columns.push_back({"fraction." + std::string(name_of(regime)), title, "", ".1%"});
    }
    columns.push_back({"fraction.slack", "slack", "", ".1%"});
    columns.push_back({"fraction.still", "still", "", ".1%"});
    return columns;
}

}  // namespace

reports::Answer duty_answer(const Recording& recording, const duty::DutyCycle& duty) {
    reports::Answer answer{.id = "duty", .kind = "Duty cycle of a recording", .title = recording.name};
    Data& values = answer.values;
    values = {{"case", recording.name}, {"unsolved_steps", duty.unsolved_steps}};
    Data fractions = Data::list();
    std::string regimes;
    for (const Regime regime : all_regimes) {
        values["duty_fraction"][name_of(regime)] = duty.fraction(regime);
        fractions.push_back({{"name", name_of(regime)}, {"duty_fraction", duty.fraction(regime)}});
        regimes += fmt::format("{}{:.1f} % {}", regimes.empty() ? "" : ", ", 100.0 * duty.fraction(regime),
                               name_of(regime));
    }
    answer.headline = "fractions of the time in which a cable moves: " + regimes + ".";
    values["all"] = times_data(duty.all);
    values["runs"] = Data::list();
    Data rows = Data::list();
    for (std::size_t k = 0; k < duty.runs.size(); ++k) {
        Data run = {{"run", recording.runs[k].number}};
        run.update(times_data(duty.runs[k]));
        rows.push_back(run);
        values["runs"].push_back(std::move(run));
    }
    Data all = {{"run", "all"}};
    all.update(times_data(duty.all));
    rows.push_back(std::move(all));
    answer.sections = {
        {.id = "times", .heading = "Motion of the cables", .tables = {{"times", "", time_columns(), rows}}},
        {.id = "duty",
         .heading = "Duty cycle, for [[regime]] of a study's configuration",
         .tables =
             {{"duty", "", {{"name", "name"}, {"duty_fraction", "duty_fraction", "", ".4f"}}, fractions}},
         .note =
             "The fractions of the regimes that a study has must sum to 1; `capstan place CONFIG --duty LOG` "
             "takes care of that."}};
    if (duty.unsolved_steps > 0)
        answer.sections.back().note +=
            fmt::format(" {} steps of the model did not verify.", duty.unsolved_steps);
    return answer;
}

}  // namespace capstan::answers
