// Running studies: starting them from a text or a named configuration, watching, stopping and resuming them.
#include <algorithm>
#include <limits>

#include "capstan/cable/invalid_input.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"
#include "capstan/platform/files.h"
#include "capstan/service/cost_estimate.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/storage/study_store.h"

namespace capstan::service {

namespace {

// A bench is simulated at the shell; it is not a study.
bool is_study(const std::filesystem::path& file) {
    return read_file(file).find("\nkind = \"bench\"") == std::string::npos;
}

std::vector<std::string> config_names(const ServiceOptions& options) {
    std::vector<std::string> names;
    if (!options.configs) return names;
    for (const auto& entry : std::filesystem::directory_iterator(*options.configs)) {
        if (entry.is_regular_file() && entry.path().extension() == ".toml" && is_study(entry.path()))
            names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

struct ConfigText {
    std::string toml;
    std::string name;
    /// Files that a configuration names are read only beside those of the service's own folder.
    std::optional<std::filesystem::path> folder;
};

ConfigText config_text_of(const RouteContext& context, const nlohmann::json& body) {
    if (!body.contains("config")) return {member<std::string>(body, "config_toml"), "configuration", {}};
    const auto name = member<std::string>(body, "config");
    return {config_named(context.options, name), name, context.options.configs};
}

ordered_json start(RouteContext& context, const nlohmann::json& body) {
    std::vector<std::pair<std::string, std::string>> named_toml;
    std::size_t bytes = 0;
    for (const StudyPlan& plan : studies_in(context, body)) {
        named_toml.emplace_back(plan.name, config::config_text(plan, config::Comments::none));
        bytes += named_toml.back().second.size();
    }
    context.queue.require_room(named_toml.size(), bytes);
    ordered_json started = ordered_json::array();
    for (const Job& job : context.queue.add_studies(named_toml)) started.push_back(job_json(job));
    return started;
}

// Every problem, and how many studies there are: before anything is started.
ordered_json check(RouteContext& context, const nlohmann::json& body) {
    const ConfigText text = config_text_of(context, body);
    try {
        const auto plans =
            config::runnable_studies(config::parse_plan<StudyPlan>(text.toml, text.name, text.folder));
        return {{"problems", ordered_json::array()},
                {"studies", plans.size()},
                {"over_worlds", plans.front().uncertainty.is_stated}};
    } catch (const InvalidInput& error) {
        return {{"problems", error.problems()}, {"studies", 0}, {"over_worlds", false}};
    }
}

ordered_json resume_study(RouteContext& context, std::int64_t study_id) {
    storage::Database database = context.open();
    study_state(database, study_id);
    for (const Job& job : context.queue.jobs()) {
        if (job.kind != JobKind::study || job.result_id != study_id) continue;
        if (job.state == JobState::queued || job.state == JobState::running) return job_json(job);
        if (context.queue.resume(job.number)) return job_json(*context.queue.find(job.number));
    }
    const auto record = storage::load_study(database, study_id).study;
    if (record.status == "complete") throw BadRequest("the study is complete already", 409);
    return job_json(context.queue.add_resume(record.name, study_id));
}

// Of a job that begins anew. Of a stored study that goes on it is not known.
ordered_json cost_of(const RouteContext& context, const Job& job) {
    const JobCommands& commands = context.options.commands;
    const std::string input = context.queue.input_of(job);
    if (job.result_id) return {{"known", false}};
    if (job.kind == JobKind::study) return cost_of_studies_in(context, {{"config_toml", read_file(input)}});
    if (job.kind == JobKind::diagnosis) return cost_of_diagnosis(commands, input);
    std::vector<std::string> words{std::string(name_of(job.kind)), input};
    words.insert(words.end(), job.options.begin(), job.options.end());
    return cost_of_command(commands, words);
}

void require(bool holds, const char* what) {
    if (!holds) throw BadRequest(what, 409);
}

}  // namespace

std::vector<StudyPlan> studies_in(const RouteContext& context, const nlohmann::json& body) {
    const ConfigText text = config_text_of(context, body);
    try {
        return config::runnable_studies(config::parse_plan<StudyPlan>(text.toml, text.name, text.folder));
    } catch (const InvalidInput& error) {
        throw BadRequest(error.what());
    }
}

Job job_in_path(const RouteContext& context, const http::Request& request) {
    const std::int64_t number = number_in_path(request);
    const auto job = number <= std::numeric_limits<int>::max() ? context.queue.find(static_cast<int>(number))
                                                               : std::nullopt;
    if (!job) throw BadRequest("there is no such job", 404);
    return *job;
}

// Accepts only names that are in the folder, so that no path leads out of it.
std::string config_named(const ServiceOptions& options, const std::string& name) {
    const auto names = config_names(options);
    if (std::find(names.begin(), names.end(), name) == names.end())
        throw BadRequest("there is no configuration '" + name + "'", 404);
    return read_file(*options.configs / name);
}

std::vector<Route> job_routes(RouteContext& context) {
    const auto list_configs = [&](const http::Request&, http::Response& response) {
        send_json(response, config_names(context.options));
    };
    const auto show_config = [&](const http::Request& request, http::Response& response) {
        send_text(response, config_named(context.options, request.path_values.front()),
                  "text/plain; charset=utf-8");
    };
    const auto check_config = [&](const http::Request& request, http::Response& response) {
        send_json(response, check(context, body_of(request)));
    };
    const auto start_studies = [&](const http::Request& request, http::Response& response) {
        send_json(response, start(context, body_of(request)), 202);
    };
    const auto resume_stored = [&](const http::Request& request, http::Response& response) {
        send_json(response, resume_study(context, number_in_path(request)), 202);
    };
    const auto list_jobs = [&](const http::Request&, http::Response& response) {
        ordered_json list = ordered_json::array();
        for (const Job& job : context.queue.jobs()) list.push_back(job_json(job));
        send_json(response, list);
    };
    const auto show_job = [&](const http::Request& request, http::Response& response) {
        send_json(response, job_json(job_in_path(context, request)));
    };
    const auto stop_job = [&](const http::Request& request, http::Response& response) {
        const Job job = job_in_path(context, request);
        require(context.queue.stop(job.number), "only a queued or running job can be stopped");
        send_json(response, job_json(*context.queue.find(job.number)), 202);
    };
    const auto stop_all = [&](const http::Request&, http::Response& response) {
        send_json(response, {{"stopped", context.queue.stop_all()}}, 202);
    };
    const auto resume_job = [&](const http::Request& request, http::Response& response) {
        const Job job = job_in_path(context, request);
        require(context.queue.resume(job.number), "only a stopped or failed job can be resumed");
        send_json(response, job_json(*context.queue.find(job.number)), 202);
    };
    const auto tell_cost = [&](const http::Request& request, http::Response& response) {
        send_json(response, cost_of(context, job_in_path(context, request)));
    };
    return {
        {"get", "/api/configs", "listConfigs",
         "Names of the configurations in the folder that `capstan serve --configs` named", "Names",
         json_of("[string]"), list_configs},
        {"get",
         "/api/configs/{name}",
         "showConfig",
         "The text of a configuration",
         "TOML",
         {{"text/plain", "string"}},
         show_config},
        {"post",
         "/api/configs/check",
         "checkConfig",
         "Every problem of a configuration, as `capstan config check`, and how many studies it describes",
         "Problems, each a line; the number of studies; whether they are over worlds",
         json_of("object"),
         check_config,
         200,
         {400, 404},
         {{"config", "string", "A name of /api/configs; or", false},
          {"config_toml", "string", "the text of a configuration", false}},
         "application/json",
         Lane::reports},
        {"post",
         "/api/studies",
         "startStudy",
         "Queue the studies that a configuration describes",
         "One job for each study",
         json_of("[Job]"),
         start_studies,
         202,
         {400, 404, 503, 507},
         {{"config", "string", "A name of /api/configs; or", false},
          {"config_toml", "string", "the text of a configuration", false}}},
        {"post",
         "/api/studies/{study_id}/resume",
         "resumeStudy",
         "Resume a study that was stopped or killed",
         "Its job",
         json_of("Job"),
         resume_stored,
         202,
         {409}},
        {"get", "/api/jobs", "listJobs", "The queue, oldest first", "Jobs", json_of("[Job]"), list_jobs},
        {"get", "/api/jobs/{job}", "showJob", "One job", "The job", json_of("Job"), show_job},
        {"post", "/api/jobs/stop", "stopAllJobs",
         "Stop every queued job, and the running one after its current unit", "How many", json_of("object"),
         stop_all, 202},
        {"post",
         "/api/jobs/{job}/stop",
         "stopJob",
         "Stop a queued job, or a running one after its current unit",
         "The job",
         json_of("Job"),
         stop_job,
         202,
         {409}},
        {"post",
         "/api/jobs/{job}/resume",
         "resumeJob",
         "Queue a stopped or failed job again; stored results stay",
         "The job",
         json_of("Job"),
         resume_job,
         202,
         {409}},
        {"post",
         "/api/jobs/{job}/cost",
         "jobCost",
         "What resumeJob would cost on this machine where the job begins anew; it is not known of a stored study",
         "The cost",
         json_of("object"),
         tell_cost,
         200,
         {503},
         {},
         "application/json",
         Lane::imports},
    };
}

}  // namespace capstan::service
