#include "capstan/service/job_results.h"

#include <algorithm>

#include "capstan/platform/files.h"
#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/study_store.h"

namespace capstan::service {

std::filesystem::path file_of(const JobFolder& folder, const Job& job, const std::string& name) {
    return folder.path() / std::to_string(job.number) / name;
}

std::vector<std::string> command_line(const JobFolder& folder, const JobCommands& commands, const Job& job) {
    const std::string input = (folder.path() / job.file).string();
    std::vector<std::string> words{commands.program};
    const auto add = [&](std::vector<std::string> more) {
        words.insert(words.end(), more.begin(), more.end());
    };
    const auto beside = [&](const char* name) { return file_of(folder, job, name).string(); };
    bool uses_database = true;
    switch (job.kind) {
        case JobKind::study:
            if (job.result_id)
                add({"study", "resume", std::to_string(*job.result_id), "--json"});
            else
                add({"study", "run", input, "--json"});
            break;
        case JobKind::diagnosis:
            add({"diagnose", input, "--json", "-o", beside(answer_file), "--html", beside(page_file),
                 "--save", beside(model_file)});
            break;
        case JobKind::place:
        case JobKind::sensitivity:
        case JobKind::estimate:
            add({std::string(name_of(job.kind)), input, "--json", "-o", beside(answer_file), "--html",
                 beside(page_file)});
            add(job.options);
            uses_database = false;
            break;
    }
    if (uses_database) add({"--db", commands.database});
    add({"--progress", "json", "--jobs", std::to_string(commands.threads)});
    return words;
}

std::int64_t last_id(const JobCommands& commands, JobKind kind) {
    storage::Database database = storage::Database::open_read_only(commands.database);
    std::int64_t last = 0;
    if (kind == JobKind::study) {
        for (const auto& study : storage::list_studies(database)) last = std::max(last, study.study_id);
    } else if (kind == JobKind::diagnosis) {
        for (const auto& each : storage::list_diagnoses(database)) last = std::max(last, each.diagnosis_id);
    }
    return last;
}

std::optional<std::int64_t> result_of(const JobFolder& folder, const JobCommands& commands, const Job& job) {
    if (job.result_id || !stores_result(job.kind)) return job.result_id;
    storage::Database database = storage::Database::open_read_only(commands.database);
    if (job.kind == JobKind::study) {
        const std::string config = read_file(folder.path() / job.file);
        for (const auto& study : storage::list_studies(database)) {
            if (study.study_id > job.last_before &&
                storage::load_study(database, study.study_id).study.config_toml == config)
                return study.study_id;
        }
        return std::nullopt;
    }
    for (const auto& each : storage::list_diagnoses(database)) {
        if (each.diagnosis_id > job.last_before && each.log_file == (folder.path() / job.file).string())
            return each.diagnosis_id;
    }
    return std::nullopt;
}

bool is_complete(const JobFolder& folder, const JobCommands& commands, const Job& job) {
    if (!stores_result(job.kind)) return std::filesystem::exists(file_of(folder, job, answer_file));
    if (!job.result_id) return false;
    if (job.kind == JobKind::diagnosis) return true;  // it is stored in one piece, at its end
    storage::Database database = storage::Database::open_read_only(commands.database);
    return storage::load_study(database, *job.result_id).study.status == "complete";
}

std::string plain_messages(std::string text, const std::string& folder) {
    constexpr std::size_t max_message_bytes = 20000;
    for (const std::string& unwanted : {folder + "/", std::string("capstan: ")}) {
        for (std::size_t at = 0; (at = text.find(unwanted, at)) != std::string::npos;)
            text.erase(at, unwanted.size());
    }
    while (text.ends_with('\n')) text.pop_back();
    return text.size() > max_message_bytes ? text.substr(0, max_message_bytes) + " ..." : text;
}

}  // namespace capstan::service
