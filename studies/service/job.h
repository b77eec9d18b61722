#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "capstan/platform/progress.h"

namespace capstan::service {

enum class JobKind {
    study,
    diagnosis,
    place,  ///< these three store nothing in the database: their answer is a page
    sensitivity,
    estimate,
};

/// In the database, under the number Job::result_id.
bool stores_result(JobKind kind);

enum class JobState {
    queued,   ///< waits for those before it
    running,  ///< under way, or was when the service ended: then it goes on at the next start
    stopped,  ///< by a person, who may resume it
    done,
    failed,
};

std::string_view name_of(JobKind kind);
std::string_view name_of(JobState state);

/// One thing to be done. What is kept over a restart is all but `progress`.
struct Job {
    int number = 0;  ///< from 1
    JobKind kind = JobKind::study;
    std::string title;                   ///< the study's or recording's name
    std::string file;                    ///< in the queue's folder: the configuration, or the log
    std::vector<std::string> options{};  ///< of the command, beyond those of every job
    JobState state = JobState::queued;
    /// The largest study_id or diagnosis_id before the job was first started: what it has begun is beyond.
    std::int64_t last_before = 0;
    std::optional<std::int64_t> result_id;  ///< study_id or diagnosis_id, as soon as it is known
    std::string message;                    ///< why it failed; empty otherwise
    ProgressEvent progress;

    bool operator==(const Job&) const = default;
};

/// A job as the service's clients see it.
nlohmann::ordered_json job_json(const Job& job);

/// The kept part of jobs as JSON, and back. Throws std::runtime_error if the text is not from `jobs_text`.
std::string jobs_text(const std::vector<Job>& jobs);
std::vector<Job> read_jobs(const std::string& text);

}  // namespace capstan::service
