#include "capstan/service/routes.h"
#include "capstan/service/study_state.h"

namespace capstan::service {

std::shared_ptr<const std::string> RouteContext::about_study(const std::string& what,
                                                             storage::Database& database,
                                                             std::int64_t study_id,
                                                             const ReportShelf::Maker& make) {
    const StudyState state = study_state(database, study_id);
    return reports.get(
        what + " " + std::to_string(study_id), state.words,
        state.is_complete ? ReportShelf::Freshness::exact : ReportShelf::Freshness::a_moment_old, make);
}

}  // namespace capstan::service
