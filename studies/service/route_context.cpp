#include <fmt/format.h>

#include "capstan/service/bad_request.h"
#include "capstan/service/routes.h"
#include "capstan/storage/study_store.h"

namespace capstan::service {

std::vector<Route> in_lane(Lane lane, std::vector<Route> routes) {
    for (Route& route : routes) route.lane = lane;
    return routes;
}

StudyState study_state(storage::Database& database, std::int64_t study_id) {
    for (const storage::StudySummary& study : storage::list_studies(database)) {
        if (study.study_id == study_id)
            return {fmt::format("{} {} of {} {}", study.name, study.units_done, study.units, study.status),
                    study.status == "complete"};
    }
    throw BadRequest(fmt::format("there is no study {}", study_id), 404);
}

std::shared_ptr<const http::KeptText> RouteContext::about_study(const std::string& what,
                                                                storage::Database& database,
                                                                std::int64_t study_id,
                                                                const ReportShelf::Maker& make) {
    const StudyState state = study_state(database, study_id);
    return reports.get(
        what + " " + std::to_string(study_id), state.words,
        state.is_complete ? ReportShelf::Freshness::exact : ReportShelf::Freshness::a_moment_old, make);
}

std::string RouteContext::answer_of_job(const http::Request& request, const char* name) const {
    const Job job = job_in_path(*this, request);
    std::string text = queue.written_by(job, name);
    if (text.empty()) throw BadRequest("job " + std::to_string(job.number) + " has no such answer", 404);
    return text;
}

}  // namespace capstan::service
