#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace capstan::cluster {

/// The time [s] of the disk on which the folder is: the clocks of machines that share it may differ. Of a
/// folder that may not be written, this machine's.
double disk_time_s(const std::filesystem::path& folder);

/// What stands in a lease: who works on a unit, and since when.
struct LeaseRecord {
    std::string worker;        ///< host and process
    double begun_s = 0.0;      ///< disk_time_s() when the work began
    double last_beat_s = 0.0;  ///< when the worker was last heard of
};

/// A file that says that a worker works on something. It is made by one worker only; its modification time is
/// renewed every few seconds while the worker lives, so that the lease of a dead one is recognised.
class Lease {
  public:
    /// Longer than any pause of a worker that lives.
    static constexpr double stale_after_s = 60.0;

    /// Nothing if a living worker holds it already.
    static std::optional<Lease> claim(const std::filesystem::path& file);

    /// Takes it whoever holds it.
    static Lease take(const std::filesystem::path& file);

    Lease(Lease&&) noexcept;
    Lease& operator=(Lease&&) = delete;
    Lease(const Lease&) = delete;
    ~Lease();  ///< gives it back

    double begun_s() const { return begun_s_; }

  private:
    Lease(std::filesystem::path file, double begun_s);

    std::filesystem::path file_;
    double begun_s_ = 0.0;
    std::shared_ptr<std::atomic<bool>> ends_;
    std::thread heart_;
};

/// Nothing: there is no lease, or a damaged one.
std::optional<LeaseRecord> read_lease(const std::filesystem::path& file);

/// Whether a worker holds it that was heard of lately; `now_s` as disk_time_s() gives it.
bool is_held(const std::filesystem::path& file, double now_s);

/// "node7-4711": this process, in the names of files and in messages.
std::string this_worker();

}  // namespace capstan::cluster
