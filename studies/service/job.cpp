#include "capstan/service/job.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace capstan::service {

namespace {

using nlohmann::ordered_json;

constexpr std::array kinds{JobKind::study, JobKind::diagnosis, JobKind::place, JobKind::sensitivity,
                           JobKind::estimate};
constexpr std::array states{JobState::queued, JobState::running, JobState::stopped, JobState::done,
                            JobState::failed};

template <class Name, std::size_t Count>
Name named(const std::array<Name, Count>& all, const std::string& name) {
    for (const Name each : all) {
        if (name_of(each) == name) return each;
    }
    throw std::runtime_error("'" + name + "' is unknown");
}

}  // namespace

std::string_view name_of(JobKind kind) {
    switch (kind) {
        case JobKind::study:
            return "study";
        case JobKind::diagnosis:
            return "diagnosis";
        case JobKind::place:
            return "place";
        case JobKind::sensitivity:
            return "sensitivity";
        case JobKind::estimate:
            return "estimate";
    }
    return "";
}

bool stores_result(JobKind kind) {
    return kind == JobKind::study || kind == JobKind::diagnosis;
}

std::string_view name_of(JobState state) {
    switch (state) {
        case JobState::queued:
            return "queued";
        case JobState::running:
            return "running";
        case JobState::stopped:
            return "stopped";
        case JobState::done:
            return "done";
        case JobState::failed:
            return "failed";
    }
    return "";
}

ordered_json job_json(const Job& job) {
    const ProgressEvent& progress = job.progress;
    ordered_json json = {
        {"job", job.number},
        {"kind", name_of(job.kind)},
        {"title", job.title},
        {"state", name_of(job.state)},
        {"activity", progress.items.empty()
                         ? progress.activity
                         : fmt::format("{} of {} {}", progress.done, progress.total, progress.items)},
        {"fraction", progress.fraction},
        {"seconds_left", progress.seconds_left ? ordered_json(*progress.seconds_left) : ordered_json()},
        {"max_seconds_left",
         progress.max_seconds_left ? ordered_json(*progress.max_seconds_left) : ordered_json()},
        {"message", job.message}};
    if (stores_result(job.kind))
        json[job.kind == JobKind::study ? "study_id" : "diagnosis_id"] =
            job.result_id ? ordered_json(*job.result_id) : ordered_json(nullptr);
    return json;
}

std::string jobs_text(const std::vector<Job>& jobs) {
    ordered_json list = ordered_json::array();
    for (const Job& job : jobs) {
        list.push_back({{"job", job.number},
                        {"kind", name_of(job.kind)},
                        {"title", job.title},
                        {"file", job.file},
                        {"options", job.options},
                        {"state", name_of(job.state)},
                        {"last_before", job.last_before},
                        {"result_id", job.result_id ? ordered_json(*job.result_id) : ordered_json(nullptr)},
                        {"message", job.message}});
    }
    return list.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::vector<Job> read_jobs(const std::string& text) {
    std::vector<Job> jobs;
    try {
        for (const auto& each : ordered_json::parse(text)) {
            Job job;
            job.number = each.at("job");
            job.kind = named(kinds, each.at("kind"));
            job.title = each.at("title");
            job.file = each.at("file");
            job.options = each.value("options", std::vector<std::string>{});
            job.state = named(states, each.at("state"));
            job.last_before = each.at("last_before");
            if (!each.at("result_id").is_null()) job.result_id = each.at("result_id").get<std::int64_t>();
            job.message = each.at("message");
            jobs.push_back(std::move(job));
        }
    } catch (const std::exception& error) {
        throw std::runtime_error(std::string("the list of jobs cannot be read: ") + error.what());
    }
    return jobs;
}

}  // namespace capstan::service
