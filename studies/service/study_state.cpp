#include "capstan/service/study_state.h"

#include <fmt/format.h>

#include "capstan/service/bad_request.h"
#include "capstan/storage/study_store.h"

namespace capstan::service {

StudyState study_state(storage::Database& database, std::int64_t study_id) {
    for (const storage::StudySummary& study : storage::list_studies(database)) {
        if (study.study_id == study_id)
            return {fmt::format("{} {} of {} {}", study.name, study.units_done, study.units, study.status),
                    study.status == "complete"};
    }
    throw BadRequest(fmt::format("there is no study {}", study_id), 404);
}

}  // namespace capstan::service
