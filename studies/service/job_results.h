#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/service/job_folder.h"
#include "capstan/service/job_queue.h"

namespace capstan::service {

/// What a job's command writes beside its input: the answer as JSON and as a page. The answer comes last.
inline constexpr const char* answer_file = "answer.json";
inline constexpr const char* page_file = "page.html";
inline constexpr const char* model_file = "model.toml";  ///< of a diagnosis

std::filesystem::path file_of(const JobFolder& folder, const Job& job, const std::string& name);

/// The command that does the job, or goes on with it.
std::vector<std::string> command_line(const JobFolder& folder, const JobCommands& commands, const Job& job);

/// The largest study_id or diagnosis_id in the database; 0 of a kind that stores nothing there.
std::int64_t last_id(const JobCommands& commands, JobKind kind);

/// The study or diagnosis that the job has begun; nothing of other kinds.
std::optional<std::int64_t> result_of(const JobFolder& folder, const JobCommands& commands, const Job& job);

/// Nothing is left to be done.
bool is_complete(const JobFolder& folder, const JobCommands& commands, const Job& job);

/// What a command said, as a person reads it: without the program's name and the folder, at most 20 kB.
std::string plain_messages(std::string text, const std::string& folder);

}  // namespace capstan::service
