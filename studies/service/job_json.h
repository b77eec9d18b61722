#pragma once

#include <nlohmann/json.hpp>

#include "capstan/service/job.h"

namespace capstan::service {

/// A job as those who watch see it.
inline nlohmann::ordered_json job_json(const Job& job) {
    using Json = nlohmann::ordered_json;
    Json json = {{"job", job.number},
                 {"kind", name_of(job.kind)},
                 {"title", job.title},
                 {"state", name_of(job.state)},
                 {"doing", job.doing},
                 {"fraction_done", job.fraction_done},
                 {"left_s", job.left_s ? Json(*job.left_s) : Json(nullptr)},
                 {"message", job.message}};
    json[job.kind == JobKind::study ? "study_id" : "diagnosis_id"] =
        job.result_id ? Json(*job.result_id) : Json(nullptr);
    return json;
}

}  // namespace capstan::service
