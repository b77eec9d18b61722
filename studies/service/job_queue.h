#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "capstan/platform/child_process.h"
#include "capstan/service/job_folder.h"

namespace capstan::service {

/// The commands that the queue runs, each in a process of its own: a study gives the same bits as in a shell,
/// and no job can end the service.
struct JobCommands {
    std::string program;   ///< path of capstan
    std::string database;  ///< path of the results database
    int threads = 0;       ///< of a job; 0: all processors
    const std::atomic<bool>* ending =
        nullptr;  ///< the service ends: a process of a request is not waited for
};

/// Runs jobs one after the other, in the order they came. Every change of the list is on the disk before a
/// client sees it. A job that was running when the service was killed is resumed at the next start.
class JobQueue {
  public:
    JobQueue(std::filesystem::path folder, JobCommands commands);
    /// Ends the job under way, which is kept as running.
    ~JobQueue();
    JobQueue(const JobQueue&) = delete;
    JobQueue& operator=(const JobQueue&) = delete;

    std::vector<Job> jobs() const;
    std::optional<Job> find(int number) const;

    /// Throws BadRequest if so many more jobs would be too many (503), or their files too large (507).
    void require_room(std::size_t jobs, std::uintmax_t bytes) const;

    /// Configurations by the name of their study: all of them become jobs, or none.
    std::vector<Job> add_studies(const std::vector<std::pair<std::string, std::string>>& named_toml);
    /// A command on a configuration that leaves an answer and a page.
    Job add_answer(JobKind kind, const std::string& name, const std::string& toml,
                   std::vector<std::string> options);
    /// The same on a recording: `log` and `sidecar` are the bytes of NAME.csv and NAME.json.
    Job add_recording(JobKind kind, const std::string& name, std::string_view log, std::string_view sidecar,
                      std::vector<std::string> options = {});
    /// A study that was begun without this queue, or whose job is forgotten.
    Job add_resume(const std::string& name, std::int64_t study_id);

    /// False if the job is not in a state to be stopped, or to be resumed.
    bool stop(int number);
    bool resume(int number);

    /// How many that waited or ran; the running one ends after its unit.
    int stop_all();

    /// The configuration or the log that a job was given; it may be gone.
    std::string input_of(const Job& job) const { return (folder_.path() / job.file).string(); }

    /// What a job wrote beside its input, under one of the names of job_results.h. Empty if it is not done,
    /// or its files are gone.
    std::string written_by(const Job& job, const std::string& name) const;

    /// What the job of a stored diagnosis wrote: answer.json, page.html or model.toml. Empty if it was not
    /// made here, or its files are gone.
    std::string answer_of(std::int64_t diagnosis_id, const std::string& name) const;

  private:
    void work();
    void run(Job job);
    void on_output(int number, const std::string& line, std::string& messages);
    /// With the next number; while locked.
    Job new_job(const std::string& title, JobKind kind = JobKind::study,
                std::vector<std::string> options = {}) const;
    Job add(Job job);
    /// All of them, or none where the disk refuses.
    std::vector<Job> add(const std::vector<Job>& added);
    void fail(int number, const std::string& message);
    void keep();              // what was added; while locked
    void drop_old();          // while locked
    int next_number() const;  // while locked
    void change(int number, const std::function<void(Job&)>& to);

    JobFolder folder_;
    JobCommands commands_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Job> jobs_;
    std::unique_ptr<ChildProcess> child_;
    int running_ = 0;  // number of the job under way; 0: none
    bool stop_asked_ = false;
    bool ending_ = false;
    std::thread worker_;
};

}  // namespace capstan::service
