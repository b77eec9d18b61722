// Queuing the diagnosis of a recording, and reading stored diagnoses.
#include "capstan/answers/recording_answers.h"
#include "capstan/answers/study_answers.h"
#include "capstan/reports/query_rows.h"
#include "capstan/service/cost_estimate.h"
#include "capstan/service/exchange.h"
#include "capstan/service/job_results.h"
#include "capstan/service/routes.h"
#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/report_queries.h"

namespace capstan::service {

namespace {

Job start(RouteContext& context, const http::Request& request) {
    const UploadedRecording recording = recording_of(request);
    return context.queue.add_recording(JobKind::diagnosis, recording.title, recording.log, recording.sidecar);
}

// What the command wrote, if the diagnosis was made here.
std::string answer_of(RouteContext& context, std::int64_t diagnosis_id) {
    if (std::string answer = context.queue.answer_of(diagnosis_id, answer_file); !answer.empty())
        return answer;
    return reports::answer_json(stored_answer_of(context, diagnosis_id));
}

}  // namespace

reports::Answer stored_answer_of(const RouteContext& context, std::int64_t diagnosis_id) {
    storage::Database database = context.open();
    for (const auto& each : storage::list_diagnoses(database))
        if (each.diagnosis_id == diagnosis_id)
            return answers::stored_diagnosis_answer(storage::load_diagnosis(database, diagnosis_id));
    throw BadRequest("there is no diagnosis " + std::to_string(diagnosis_id), 404);
}

UploadedRecording recording_of(const http::Request& request) {
    for (const char* part : {"log", "sidecar"}) {
        if (request.part(part) == nullptr)
            throw BadRequest(std::string("the part '") + part +
                             "' is missing: send NAME.csv as 'log' and NAME.json as 'sidecar'");
    }
    const std::string_view sidecar = request.part("sidecar")->content;
    if (!nlohmann::json::parse(sidecar, nullptr, false).is_object())
        throw BadRequest("the sidecar is not a JSON object");
    const std::string& name = request.part("log")->filename;
    const std::string title = name.substr(name.find_last_of("/\\") + 1);
    return {title.empty() ? "recording" : title.substr(0, 200), request.part("log")->content, sidecar};
}

std::vector<Route> diagnosis_routes(RouteContext& context) {
    const auto list = [&](const http::Request&, http::Response& response) {
        storage::Database database = context.open();
        send_text(response, reports::rows_json(storage::run_read_only(database, storage::diagnoses_query)),
                  "application/json");
    };
    const auto start_diagnosis = [&](const http::Request& request, http::Response& response) {
        send_json(response, job_json(start(context, request)), 202);
    };
    const auto tell_cost = [&](const http::Request& request, http::Response& response) {
        send_json(response, cost_of_diagnosis(context.options.commands, recording_of(request)));
    };
    const auto show = [&](const http::Request& request, http::Response& response) {
        send_text(response, answer_of(context, number_in_path(request)), "application/json");
    };
    const auto model = [&](const http::Request& request, http::Response& response) {
        std::string text = context.queue.answer_of(number_in_path(request), model_file);
        if (text.empty()) throw BadRequest("the model of this diagnosis is not kept here", 404);
        response.add_header("Content-Disposition",
                            "attachment; filename=\"model-" + request.path_values.front() + ".toml\"");
        send_text(response, std::move(text), "application/toml");
    };
    return {
        {"get", "/api/diagnoses", "listDiagnoses", "The stored diagnoses, newest first: v_diagnosis",
         "Diagnoses", json_of("[object]"), list},
        {"post",
         "/api/diagnoses",
         "startDiagnosis",
         "Queue the diagnosis of a recording",
         "Its job",
         json_of("Job"),
         start_diagnosis,
         202,
         {400, 413, 503, 507},
         {{"log", "binary", "NAME.csv"}, {"sidecar", "binary", "NAME.json"}},
         "multipart/form-data"},
        {"post",
         "/api/diagnoses/cost",
         "diagnosisCost",
         "How long startDiagnosis would take on this machine, by a pilot",
         "The cost: what is found decides between min_seconds and seconds",
         json_of("object"),
         tell_cost,
         200,
         {400, 413, 503},
         {{"log", "binary", "NAME.csv"}, {"sidecar", "binary", "NAME.json"}},
         "multipart/form-data",
         Lane::imports},
        {"get",
         "/api/diagnoses/{diagnosis_id}/model",
         "diagnosedModel",
         "The corrected model of the bench, as `capstan diagnose --save` writes it, if the service made the diagnosis",
         "The model",
         {{"application/toml", "string"}},
         model},
        {"get", "/api/diagnoses/{diagnosis_id}", "showDiagnosis",
         "As `capstan diagnose --json` writes it. A diagnosis that was not made by this service lacks "
         "`non_identifiable`, which the database does not keep",
         "The diagnosis", json_of("object"), show},
    };
}

}  // namespace capstan::service
