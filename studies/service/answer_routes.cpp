// Questions whose answer is a page of its own: the best of all layouts, what would change the advice, the
// tension from a recording. They wait in the same queue as studies.
#include <fmt/format.h>

#include <array>

#include "capstan/config/config_writer.h"
#include "capstan/platform/files.h"
#include "capstan/service/cost_estimate.h"
#include "capstan/service/import_folder.h"
#include "capstan/service/job_results.h"
#include "capstan/service/routes.h"

namespace capstan::service {

namespace {

constexpr std::array askable{JobKind::place, JobKind::sensitivity, JobKind::estimate};

JobKind kind_of(const nlohmann::json& body) {
    const auto name = member<std::string>(body, "command");
    for (const JobKind kind : askable)
        if (name == name_of(kind)) return kind;
    throw BadRequest("'command' is '" + name + "', but must be place, sensitivity or estimate");
}

std::vector<std::string> options_of(JobKind kind, const nlohmann::json& body, const StudyPlan& plan) {
    std::vector<std::string> options;
    if (body.contains("noise")) {
        const auto label = member<std::string>(body, "noise");
        if (kind == JobKind::estimate || plan.uncertainty.is_stated)
            throw BadRequest("'noise' is for place and sensitivity of a study at instants");
        options.insert(options.end(), {"--noise", label});
    }
    if (body.contains("sensors")) {
        const int sensors = member<int>(body, "sensors");
        if (kind != JobKind::sensitivity || plan.uncertainty.is_stated)
            throw BadRequest("'sensors' is for sensitivity of a study at instants");
        options.insert(options.end(), {"--sensors", std::to_string(sensors)});
    }
    return options;
}

ordered_json start_answers(RouteContext& context, const nlohmann::json& body) {
    const JobKind kind = kind_of(body);
    ordered_json started = ordered_json::array();
    for (const StudyPlan& plan : studies_in(context, body))
        started.push_back(job_json(context.queue.add_answer(kind, plan.name,
                                                            config::config_text(plan, config::Comments::none),
                                                            options_of(kind, body, plan))));
    return started;
}

// Of a sweep the first one's, times their number: a sweep changes a number, not the kind of work.
ordered_json cost_of_answers(RouteContext& context, const nlohmann::json& body) {
    const JobKind kind = kind_of(body);
    const std::vector<StudyPlan> plans = studies_in(context, body);
    const PrivateFolder folder("capstan-cost");
    const std::string file = (folder.path() / "study.toml").string();
    write_file(file, config::config_text(plans.front(), config::Comments::none));
    std::vector<std::string> words{std::string(name_of(kind)), file};
    for (const std::string& option : options_of(kind, body, plans.front())) words.push_back(option);
    ordered_json cost = cost_of_command(context.options.commands, words);
    if (cost.contains("seconds")) {
        cost["studies"] = plans.size();
        cost["seconds"] = cost["seconds"].get<double>() * static_cast<double>(plans.size());
    }
    return cost;
}

std::vector<std::string> estimate_options(const http::Request& request) {
    const http::FormPart* const channel = request.part("leave_out");
    if (channel == nullptr || channel->content.empty()) return {};
    const std::string name(channel->content);
    if (name.size() > 64 || name.front() == '-')
        throw BadRequest("'leave_out' is neither the name of a channel nor `each`");
    return {"--leave-out", name};
}

ordered_json cost_of_estimate(const RouteContext& context, const http::Request& request) {
    const UploadedRecording recording = recording_of(request);
    const PrivateFolder folder("capstan-cost");
    const std::string log = (folder.path() / "log.csv").string();
    write_file(log, recording.log);
    write_file(folder.path() / "log.json", recording.sidecar);
    std::vector<std::string> words{"estimate", log};
    for (const std::string& option : estimate_options(request)) words.push_back(option);
    return cost_of_command(context.options.commands, words);
}

}  // namespace

std::vector<Route> answer_routes(RouteContext& context) {
    const auto start = [&](const http::Request& request, http::Response& response) {
        send_json(response, start_answers(context, body_of(request)), 202);
    };
    const auto start_estimate = [&](const http::Request& request, http::Response& response) {
        const UploadedRecording recording = recording_of(request);
        send_json(response,
                  job_json(context.queue.add_recording(JobKind::estimate, recording.title, recording.log,
                                                       recording.sidecar, estimate_options(request))),
                  202);
    };
    const auto tell_cost = [&](const http::Request& request, http::Response& response) {
        send_json(response, cost_of_answers(context, body_of(request)));
    };
    const auto tell_cost_of_estimate = [&](const http::Request& request, http::Response& response) {
        send_json(response, cost_of_estimate(context, request));
    };
    const auto show = [&](const http::Request& request, http::Response& response) {
        send_text(response, context.answer_of_job(request, answer_file), "application/json");
    };
    const std::vector<ApiField> question{{"command", "place|sensitivity|estimate"},
                                         {"config", "string", "A name of /api/configs; or", false},
                                         {"config_toml", "string", "the text of a configuration", false},
                                         {"noise", "string", "Label of a noise level, as `--noise`", false},
                                         {"sensors", "integer", "Of sensitivity, as `--sensors`", false}};
    const std::vector<ApiField> recording{
        {"log", "binary", "NAME.csv"},
        {"sidecar", "binary", "NAME.json"},
        {"leave_out", "string", "A channel, or each: predicted from the others", false}};
    std::vector<Route> routes{
        {"post",
         "/api/answers",
         "startAnswer",
         "Queue `capstan place`, `sensitivity` or `estimate` on a configuration; one job for each of its studies",
         "The jobs",
         json_of("[Job]"),
         start,
         202,
         {400, 404, 503, 507},
         question},
        {"post",
         "/api/estimates",
         "startEstimate",
         "Queue `capstan estimate` on a recording",
         "Its job",
         json_of("Job"),
         start_estimate,
         202,
         {400, 413, 503, 507},
         recording,
         "multipart/form-data"},
        {"get", "/api/jobs/{job}/answer", "jobAnswer",
         "What the command of a job wrote with --json; a study has none", "The answer", json_of("object"),
         show},
        {"post",
         "/api/answers/cost",
         "answerCost",
         "What startAnswer would cost on this machine, found by beginning it",
         "The cost",
         json_of("object"),
         tell_cost,
         200,
         {400, 404, 503},
         question},
        {"post",
         "/api/estimates/cost",
         "estimateCost",
         "What startEstimate would cost on this machine, found by beginning it",
         "The cost",
         json_of("object"),
         tell_cost_of_estimate,
         200,
         {400, 413, 503},
         recording,
         "multipart/form-data"}};
    for (Route& route : routes)
        if (route.path.ends_with("/cost")) route.lane = Lane::imports;
    return routes;
}

}  // namespace capstan::service
