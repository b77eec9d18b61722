// How far the shards of a submitted study are.
#include <fmt/format.h>

#include <algorithm>

#include "capstan/answers/study_answers.h"
#include "capstan/cluster/study_status.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::answers {

namespace {

using cluster::StudyStatus;
using cluster::TaskStatus;
using reports::Data;

std::string outlook_words(const StudyStatus& status) {
    const cluster::Outlook& outlook = status.outlook;
    if (outlook.mean_shard_s == 0.0 || status.merge.state == "done") return {};
    return fmt::format(" Left: {:.2g} core-hours, about {:.0f} s with {} at work.", outlook.left_core_h,
                       outlook.left_s,
                       counted(static_cast<std::size_t>(std::max(outlook.running, 1)), "worker"));
}

Data task_data(const TaskStatus& task) {
    Data data = {{"state", task.state}};
    if (task.progress.units > 0) {
        data["units_done"] = task.progress.units_done;
        data["units"] = task.progress.units;
    }
    if (!task.progress.problem.empty()) data["problem"] = task.progress.problem;
    if (task.task) data["queue"] = {{"job", task.task->id}, {"state", task.task->state}};
    if (!task.worker.empty()) data["worker"] = task.worker;
    if (!task.message.empty()) data["message"] = task.message;
    return data;
}

}  // namespace

reports::Answer submitted_study_answer(const StudyStatus& status) {
    Data shards = Data::list();
    int done = 0;
    for (std::size_t k = 0; k < status.shards.size(); ++k) {
        done += status.shards[k].progress.is_done() ? 1 : 0;
        Data shard = {{"shard", k + 1}};
        shard.update(task_data(status.shards[k]));
        shards.push_back(std::move(shard));
    }
    Data rows = shards;
    Data merge = {{"shard", "merge"}};
    merge.update(task_data(status.merge));
    rows.push_back(std::move(merge));
    reports::Answer answer{
        .id = "status",
        .kind = "A submitted study",
        .title = status.directory.name,
        .headline = fmt::format("{} of {} shards are done.{} {}", done, status.directory.shards,
                                outlook_words(status), cluster::advice(status))};
    answer.values = {{"name", status.directory.name},           {"directory", status.directory.path.string()},
                     {"scheduler", status.directory.scheduler}, {"knows_queue", status.scheduler != nullptr},
                     {"workers", status.outlook.running},       {"left_core_h", status.outlook.left_core_h},
                     {"left_s", status.outlook.left_s},         {"shards", shards},
                     {"merge", task_data(status.merge)}};
    answer.sections = {{.id = "shards",
                        .heading = "Shards in " + status.directory.path.string(),
                        .tables = {{"shards",
                                    "",
                                    {{"shard", "shard"},
                                     {"state", "state"},
                                     {"units_done", "units done"},
                                     {"units", "units"},
                                     {"worker", "worker"},
                                     {"queue.job", "job"},
                                     {"queue.state", "state in the queue"},
                                     {"message", "last message"},
                                     {"problem", "problem"}},
                                    rows}}}};
    return answer;
}

}  // namespace capstan::answers
