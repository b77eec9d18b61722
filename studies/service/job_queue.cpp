#include "capstan/service/job_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "capstan/platform/files.h"
#include "capstan/platform/progress.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/service/bad_request.h"
#include "capstan/service/job_results.h"

namespace capstan::service {

namespace {

constexpr int nice_increment = 5;  // the service answers requests before a job goes on
constexpr int signal_code = 128;   // above: ended by a signal, or by a request to end (the program's 130)
constexpr std::size_t max_jobs = 1000;               // in the list; the oldest that have ended are dropped
constexpr std::size_t max_waiting = 500;             // a sweep may have some hundred
constexpr std::uintmax_t max_job_bytes = 4UL << 30;  // of the files of all jobs
constexpr std::chrono::hours kept_for{24 * 30};      // an ended job and its files

// The name of the file without anything that could lead out of the folder of the job or hide the file in it.
std::string safe_stem(const std::string& name) {
    std::string stem;
    for (const char letter : name.substr(0, name.rfind('.'))) {
        const bool plain = std::isalnum(static_cast<unsigned char>(letter)) != 0;
        stem += plain || letter == '-' ? letter : '_';
    }
    return stem.empty() || stem == "answer" ? "recording" : stem.substr(0, 60);
}

}  // namespace

JobQueue::JobQueue(std::filesystem::path folder, JobCommands commands)
    : folder_(std::move(folder)), commands_(std::move(commands)), jobs_(folder_.read()) {
    worker_ = std::thread([this] { work(); });
}

JobQueue::~JobQueue() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        if (child_) child_->ask_to_stop();
    }
    changed_.notify_all();
    worker_.join();
}

std::vector<Job> JobQueue::jobs() const {
    const std::lock_guard lock(mutex_);
    return jobs_;
}

std::optional<Job> JobQueue::find(int number) const {
    const std::lock_guard lock(mutex_);
    for (const Job& job : jobs_) {
        if (job.number == number) return job;
    }
    return std::nullopt;
}

int JobQueue::next_number() const {
    return jobs_.empty() ? 1 : jobs_.back().number + 1;
}

void JobQueue::require_room(std::size_t jobs, std::uintmax_t bytes) const {
    const std::lock_guard lock(mutex_);
    const auto waiting = std::ranges::count(jobs_, JobState::queued, &Job::state);
    if (static_cast<std::size_t>(waiting) + jobs > max_waiting)
        throw BadRequest(fmt::format("{} jobs wait already; at most {} may. Stop some, or come back later",
                                     waiting, max_waiting),
                         503);
    if (folder_.bytes() + bytes > max_job_bytes)
        throw BadRequest(fmt::format("the files of all jobs would exceed {} GB; remove old ones from {}",
                                     max_job_bytes >> 30, folder_.path().string()),
                         507);
}

// The newest stays, so that no number is given twice.
void JobQueue::drop_old() {
    const auto now = std::filesystem::file_time_type::clock::now();
    std::size_t count = jobs_.size();
    std::erase_if(jobs_, [&](const Job& job) {
        if (&job == &jobs_.back() || (job.state != JobState::done && job.state != JobState::failed))
            return false;
        const auto written = folder_.last_write(job.number);
        if (count <= max_jobs && (!written || now - *written < kept_for)) return false;
        folder_.remove(job.number);
        --count;
        return true;
    });
}

void JobQueue::keep() {
    drop_old();
    folder_.write(jobs_);
    changed_.notify_all();
}

Job JobQueue::new_job(const std::string& title, JobKind kind, std::vector<std::string> options) const {
    Job job;
    job.number = next_number();
    job.kind = kind;
    job.title = title;
    job.options = std::move(options);
    return job;
}

Job JobQueue::add(Job job) {
    return add(std::vector<Job>{std::move(job)}).front();
}

std::vector<Job> JobQueue::add(const std::vector<Job>& added) {
    const std::vector<Job> before = jobs_;
    jobs_.insert(jobs_.end(), added.begin(), added.end());
    try {
        keep();
    } catch (const std::exception&) {
        jobs_ = before;  // nobody was told of them
        throw;
    }
    return added;
}

std::vector<Job> JobQueue::add_studies(const std::vector<std::pair<std::string, std::string>>& named_toml) {
    const std::lock_guard lock(mutex_);
    std::vector<Job> added;
    int number = next_number();
    for (const auto& [name, toml] : named_toml) {
        Job job = new_job(name);
        job.number = number++;
        job.file = fmt::format("{}/study.toml", job.number);
        folder_.write_file(job.file, toml);
        added.push_back(std::move(job));
    }
    return add(added);
}

Job JobQueue::add_answer(JobKind kind, const std::string& name, const std::string& toml,
                         std::vector<std::string> options) {
    require_room(1, toml.size());
    const std::lock_guard lock(mutex_);
    Job job = new_job(name, kind, std::move(options));
    job.file = fmt::format("{}/study.toml", job.number);
    folder_.write_file(job.file, toml);
    return add(std::move(job));
}

Job JobQueue::add_recording(JobKind kind, const std::string& name, std::string_view log,
                            std::string_view sidecar, std::vector<std::string> options) {
    require_room(1, log.size() + sidecar.size());
    const std::lock_guard lock(mutex_);
    Job job = new_job(name, kind, std::move(options));
    const std::string stem = safe_stem(name);
    job.file = fmt::format("{}/{}.csv", job.number, stem);
    folder_.write_file(fmt::format("{}/{}.json", job.number, stem), sidecar);
    folder_.write_file(job.file, log);
    return add(std::move(job));
}

Job JobQueue::add_resume(const std::string& name, std::int64_t study_id) {
    require_room(1, 0);
    const std::lock_guard lock(mutex_);
    Job job = new_job(name);
    job.result_id = study_id;
    return add(std::move(job));
}

bool JobQueue::stop(int number) {
    const std::lock_guard lock(mutex_);
    for (Job& job : jobs_) {
        if (job.number != number) continue;
        if (job.state == JobState::running && running_ == number) {
            stop_asked_ = true;
            if (child_) child_->ask_to_stop();
            return true;
        }
        if (job.state != JobState::queued) return false;
        job.state = JobState::stopped;
        folder_.write(jobs_);
        return true;
    }
    return false;
}

bool JobQueue::resume(int number) {
    const std::lock_guard lock(mutex_);
    for (Job& job : jobs_) {
        if (job.number != number) continue;
        if (job.state != JobState::stopped && job.state != JobState::failed) return false;
        job.state = JobState::queued;
        job.message.clear();
        folder_.write(jobs_);
        changed_.notify_all();
        return true;
    }
    return false;
}

std::string JobQueue::written_by(const Job& job, const std::string& name) const {
    const auto file = file_of(folder_, job, name);
    return job.state == JobState::done && std::filesystem::exists(file) ? read_file(file) : "";
}

std::string JobQueue::answer_of(std::int64_t diagnosis_id, const std::string& name) const {
    for (const Job& job : jobs()) {
        if (job.kind != JobKind::diagnosis || job.result_id != diagnosis_id) continue;
        if (std::string text = written_by(job, name); !text.empty()) return text;
    }
    return "";
}

int JobQueue::stop_all() {
    int stopped = 0;
    for (const Job& job : jobs()) stopped += stop(job.number) ? 1 : 0;
    return stopped;
}

void JobQueue::change(int number, const std::function<void(Job&)>& to) {
    const std::lock_guard lock(mutex_);
    for (Job& job : jobs_) {
        if (job.number == number) to(job);
    }
    folder_.write(jobs_);
}

// Where the disk refuses this too, the job is failed until the service ends, and goes on at the next start.
void JobQueue::fail(int number, const std::string& message) {
    {
        const std::lock_guard lock(mutex_);
        child_.reset();  // ends what still runs
    }
    try {
        change(number, [&](Job& each) {
            each.state = JobState::failed;
            each.message = message;
        });
    } catch (const std::exception& error) {
        say(fmt::format("capstan serve: job {}: {}", number, error.what()));
    }
}

void JobQueue::work() {
    std::unique_lock lock(mutex_);
    while (!ending_) {
        // A job that was running when the service ended comes first.
        auto next = std::find_if(jobs_.begin(), jobs_.end(),
                                 [](const Job& job) { return job.state == JobState::running; });
        if (next == jobs_.end())
            next = std::find_if(jobs_.begin(), jobs_.end(),
                                [](const Job& job) { return job.state == JobState::queued; });
        if (next == jobs_.end()) {
            changed_.wait(lock);
            continue;
        }
        running_ = next->number;
        stop_asked_ = false;
        const Job job = *next;
        lock.unlock();
        try {
            run(job);
        } catch (const std::exception& error) {
            fail(job.number, error.what());
        }
        lock.lock();
        running_ = 0;
    }
}

void JobQueue::on_output(int number, const std::string& line, std::string& messages) {
    const std::optional<ProgressEvent> progress = read_progress_json(line);
    if (!progress) {
        const bool is_event = nlohmann::json::accept(line);  // of the job's end
        if (!line.empty() && !is_event) messages += (messages.empty() ? "" : "\n") + line;
        return;
    }
    const std::lock_guard lock(mutex_);
    for (Job& job : jobs_) {
        if (job.number == number) job.progress = *progress;
    }
}

void JobQueue::run(Job job) {
    if (job.state == JobState::running || job.result_id) {  // begun before
        job.result_id = result_of(folder_, commands_, job);
        if (is_complete(folder_, commands_, job)) {
            change(job.number, [&](Job& each) {
                each.result_id = job.result_id;
                each.state = JobState::done;
            });
            return;
        }
    } else {
        job.last_before = last_id(commands_, job.kind);
    }
    change(job.number, [&](Job& each) {
        each.state = JobState::running;
        each.last_before = job.last_before;
        each.result_id = job.result_id;
        each.progress.fraction = 0.0;
    });
    {
        const std::lock_guard lock(mutex_);
        child_ = std::make_unique<ChildProcess>(command_line(folder_, commands_, job),
                                                ChildLimits{.nice_increment = nice_increment});
        if (ending_ || stop_asked_) child_->ask_to_stop();
    }
    std::string messages;
    const CommandOutput ended = child_->wait([&](const std::string& line) {
        on_output(job.number, line, messages);
        if (!job.result_id && job.kind == JobKind::study) {
            job.result_id = result_of(folder_, commands_, job);
            if (job.result_id) change(job.number, [&](Job& each) { each.result_id = job.result_id; });
        }
    });
    job.result_id = result_of(folder_, commands_, job);
    change(job.number, [&](Job& each) {
        child_.reset();
        each.result_id = job.result_id;
        each.progress.seconds_left.reset();
        each.progress.max_seconds_left.reset();
        if (ended.exit_code == 0) {
            each.state = JobState::done;
            each.progress.fraction = 1.0;
        } else if (ending_) {
            each.state = JobState::running;  // goes on at the next start
        } else if (stop_asked_ && ended.exit_code > signal_code) {
            each.state = JobState::stopped;
        } else {
            each.state = JobState::failed;
            each.message = messages.empty()
                               ? fmt::format("ended with code {}", ended.exit_code)
                               : plain_messages(messages, file_of(folder_, job, "").parent_path().string());
        }
    });
}

}  // namespace capstan::service
