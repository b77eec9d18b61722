#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "capstan/http/response.h"
#include "capstan/http/work_lane.h"

namespace capstan::http {

/// What one client, and all of them together, may take of the service.
struct ServerLimits {
    std::size_t head_bytes = 16 << 10;
    std::size_t head_fields = 100;
    std::size_t body_bytes = 64 << 20;
    std::size_t connections = 512;
    std::size_t connections_of_one_address = 128;
    std::chrono::milliseconds head_time{10'000};  ///< for the complete head
    /// A body, or the reader of an answer, has this time, and more as its bytes go through.
    std::chrono::milliseconds body_time{10'000};
    std::size_t slowest_bytes_per_s = 64 << 10;
    std::size_t bytes_in_memory = 72 << 20;  ///< of the bodies and answers of all clients; see MemoryLimit
};

/// What becomes of a request, decided by its head.
struct Verdict {
    std::optional<Response> refusal{};   ///< sent instead of an answer; the body is not read
    std::chrono::milliseconds delay{0};  ///< before the refusal is sent
};

struct ServerOptions {
    std::function<Verdict(const Request& head)> gate;
    /// The answer that reports a problem: of the server itself, or of an exception of a handler.
    std::function<Response(int status, const std::string& message)> problem;
    std::function<Response(std::exception_ptr)> failure;
    std::vector<std::pair<std::string, std::string>>
        headers{};                                ///< of every answer that has none of the name
    std::vector<LaneLimits> lanes{LaneLimits{}};  ///< routes name them by index
    ServerLimits limits{};
};

/// An HTTP/1.1 server with one event loop: a connection costs no thread until its request is complete. Each
/// connection takes one request, so that bytes after a rejected head are never read as another. A client that
/// is slow, greedy or silent loses its connection, and the others keep theirs. Ranges are not supported, and
/// a body that is encoded or chunked is rejected.
class Server {
  public:
    explicit Server(ServerOptions options);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// `path` as RouteTable::add takes it. Before run().
    void add(const std::string& method, std::string_view path, Handler handler, std::size_t lane = 0);

    /// Listens; port 0 takes any free one. Returns the port. Throws std::runtime_error with the reason.
    int listen(const std::string& host, int port);

    /// Answers until stop() is called, from any thread.
    void run();
    void stop();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace capstan::http
