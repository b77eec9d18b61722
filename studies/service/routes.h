#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "capstan/http/server.h"
#include "capstan/reports/answer.h"
#include "capstan/service/layout_scorer.h"
#include "capstan/service/report_shelf.h"
#include "capstan/service/service.h"
#include "capstan/storage/database.h"
#include "capstan/worlds/hand_placed.h"

namespace capstan::service {

/// What the routes share. Each request opens the database for itself, for reading only.
struct RouteContext {
    const ServiceOptions& options;
    JobQueue& queue;
    ReportShelf reports;
    ReportShelf query_answers{};
    std::mutex scorers_mutex{};
    std::map<std::int64_t, std::shared_ptr<LayoutScorer>> scorers{};  // by study
    std::map<std::int64_t, std::shared_ptr<HandPlacer>> placers{};    // by study over worlds

    /// A text about a study, made when the study has gone on since; of one that is complete never an older
    /// one.
    std::shared_ptr<const http::KeptText> about_study(const std::string& what, storage::Database& database,
                                                      std::int64_t study_id, const ReportShelf::Maker& make);

    /// What the job of the path wrote; a BadRequest (404) if it wrote nothing of this name.
    std::string answer_of_job(const http::Request& request, const char* name) const;

    storage::Database open() const { return storage::Database::open_read_only(options.commands.database); }
};

/// Kinds of work that do not wait for each other, with how much of each is done at once.
enum class Lane : std::size_t {
    quick,    ///< lists, files, the queue
    reports,  ///< what reads a whole study
    scores,   ///< solves cables
    queries,  ///< a guest's SQL, each in a process of its own
    imports,  ///< uploaded files, each in a process of its own
};
std::vector<http::LaneLimits> lane_limits();  // by Lane

/// A value of the interface: its name, its type and what it means. Types are those of OpenAPI ("integer",
/// "string", "object", "binary"), the name of a component ("Job"), "[T]" for an array, "T?" for T or null,
/// and "a|b" for one of two words.
struct ApiField {
    std::string name;
    std::string type;
    std::string meaning{};
    bool is_required = true;
};

/// One row of the interface: what a client may ask, and who answers. The service and /openapi.json read it.
struct Route {
    std::string method;        ///< "get" or "post"
    std::string path;          ///< with {study_id} and the like, which are numbers from 1, or {name}
    std::string operation_id;  ///< of OpenAPI
    std::string summary;
    std::string answer;                               ///< what comes back
    std::map<std::string, std::string> answer_types;  ///< by content type, as ApiField::type
    http::Handler handler;
    int status = 200;              ///< of a success
    std::vector<int> failures{};   ///< other statuses; a path with braces also has 404
    std::vector<ApiField> body{};  ///< of a post
    std::string body_type = "application/json";
    Lane lane = Lane::quick;
};

inline std::map<std::string, std::string> json_of(std::string type) {
    return {{"application/json", std::move(type)}};
}

/// The same routes, answered in this lane.
std::vector<Route> in_lane(Lane lane, std::vector<Route> routes);

std::vector<Route> study_routes(RouteContext& context);
std::vector<Route> study_action_routes(RouteContext& context);
std::vector<Route> layout_routes(RouteContext& context);
std::vector<Route> job_routes(RouteContext& context);
std::vector<Route> answer_routes(RouteContext& context);
std::vector<Route> diagnosis_routes(RouteContext& context);
std::vector<Route> import_routes(RouteContext& context);
std::vector<Route> query_routes(RouteContext& context);

/// The text of a stored configuration; a BadRequest (404) if the folder has none of the name.
std::string config_named(const ServiceOptions& options, const std::string& name);

/// The studies of the configuration that a body names or holds. A BadRequest with everything that is wrong.
std::vector<StudyPlan> studies_in(const RouteContext& context, const nlohmann::json& body);

/// What these studies cost, as cost_estimate.h says it.
nlohmann::ordered_json cost_of_studies_in(const RouteContext& context, const nlohmann::json& body);

/// The job that the path names; a BadRequest (404) if there is none.
Job job_in_path(const RouteContext& context, const http::Request& request);

/// What the database holds of a diagnosis, which lacks the curves and the experiments that would distinguish
/// its explanations; a BadRequest (404) if there is none.
reports::Answer stored_answer_of(const RouteContext& context, std::int64_t diagnosis_id);

/// The parts `log` and `sidecar` of a request. A BadRequest if one is missing or no recording.
struct UploadedRecording {
    std::string title;  ///< for display only: the files in the queue's folder have other names
    std::string_view log;
    std::string_view sidecar;
};
UploadedRecording recording_of(const http::Request& request);

/// All of them, and /openapi.json, which describes them.
std::vector<Route> api_routes(RouteContext& context);

/// The rows as OpenAPI 3 (JSON).
std::string openapi_text(const std::vector<Route>& routes);

/// The pages for people, which are not part of the interface.
void add_page_routes(http::Server& server, RouteContext& context);

/// The content security policy of the service's own pages: they run and load only its files, and no other
/// page can frame them. The charts compile their expressions, which needs 'unsafe-eval'.
const std::string& page_policy();

/// The same for a page that holds its scripts in itself, as a report does: these scripts, by their hashes,
/// and no other.
const std::string& self_contained_page_policy();

inline constexpr const char* policy_header = "Content-Security-Policy";

/// What every answer about a study depends on: its status and how many units are done.
struct StudyState {
    std::string words;
    bool is_complete = false;
};

/// A BadRequest (404) if the study does not exist.
StudyState study_state(storage::Database& database, std::int64_t study_id);

}  // namespace capstan::service
