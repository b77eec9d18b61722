#pragma once

#include <memory>
#include <optional>
#include <string>

#include "capstan/units/shared_folder.h"

namespace capstan::units {

/// What stands in a lease: who works on a unit, and since when.
struct LeaseRecord {
    std::string worker;        ///< host and process
    double begun_s = 0.0;      ///< SharedFolder::now_s() when the work began
    double last_beat_s = 0.0;  ///< when the worker was last heard of
};

/// A file that says that a worker works on something. It is made by one worker only; its modification time is
/// renewed every few seconds while the worker lives, so that the lease of a dead one is recognised.
class Lease {
  public:
    /// Longer than any pause of a worker that lives.
    static constexpr double stale_after_s = 60.0;

    /// Nothing if a living worker holds it already.
    static std::optional<Lease> claim(SharedFolder& folder, const std::string& name);

    /// Takes it whoever holds it.
    static Lease take(SharedFolder& folder, const std::string& name);

    Lease(Lease&&) noexcept;
    Lease& operator=(Lease&&) = delete;
    Lease(const Lease&) = delete;
    ~Lease();  ///< gives it back

    double begun_s() const { return begun_s_; }

  private:
    Lease(SharedFolder& folder, std::string name, double begun_s);

    SharedFolder* folder_;
    std::string name_;
    double begun_s_ = 0.0;
    std::unique_ptr<SharedFolder::Heart> heart_;
};

/// Nothing where the lease is missing or damaged.
std::optional<LeaseRecord> read_lease(SharedFolder& folder, const std::string& name);

/// Whether a worker holds it that was heard of lately; `now_s` as SharedFolder::now_s() gives it.
bool is_held(SharedFolder& folder, const std::string& name, double now_s);

}  // namespace capstan::units
