#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "capstan/service/job_queue.h"
#include "capstan/service/request_guard.h"

namespace capstan::service {

struct ServiceOptions {
    Access access;
    JobCommands commands;                          ///< with the database's path
    std::optional<std::filesystem::path> configs;  ///< folder whose *.toml may be started by name
    double query_limit_s = 5.0;                    ///< of a guest's SQL
};

/// The HTTP service on one results database: its pages, its REST interface (openapi.json) and its queue of
/// jobs.
class Service {
  public:
    /// Binds; port 0 takes any free one. Throws std::runtime_error if the port or the queue is taken.
    explicit Service(ServiceOptions options);
    ~Service();
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;

    int port() const;

    /// Answers until stop() is called from another thread; then ends the job under way, which goes on at the
    /// next start.
    void run();
    /// From any thread, also before run().
    void stop();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace capstan::service
