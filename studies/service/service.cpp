#include "capstan/service/service.h"

#include <fmt/format.h>

#include "capstan/service/entrance.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"

namespace capstan::service {

namespace {

std::vector<std::pair<std::string, std::string>> safe_headers() {
    return {{policy_header, page_policy()},
            {"X-Content-Type-Options", "nosniff"},
            {"Referrer-Policy", "no-referrer"},
            {"Cross-Origin-Resource-Policy", "same-origin"}};
}

// Beside the file itself, so that two names of one database are one queue.
std::filesystem::path jobs_of(const std::string& database) {
    return std::filesystem::weakly_canonical(database).string() + ".jobs";
}

http::Response problem(int status, const std::string& message) {
    http::Response response;
    send_error(response, status, message);
    return response;
}

http::Response failure(const std::exception_ptr& reason) {
    try {
        std::rethrow_exception(reason);
    } catch (const BadRequest& error) {
        return problem(error.status(), error.what());
    } catch (const std::bad_alloc&) {
        return problem(503, "the service is out of memory; try again in a moment");
    } catch (const std::exception& error) {
        return problem(500, error.what());
    } catch (...) {
        return problem(500, "unknown problem");
    }
}

}  // namespace

std::vector<http::LaneLimits> lane_limits() {
    using std::chrono::seconds;
    return {
        {.threads = 4},                                              // quick
        {.threads = 4, .nice_increment = 2},                         // reports
        {.threads = 2, .waiting = 64, .nice_increment = 5},          // scores
        {.threads = 2, .waiting = 64, .longest_wait = seconds(20)},  // queries
        {.threads = 2, .waiting = 16},                               // imports
    };
}

struct Service::Parts {
    explicit Parts(ServiceOptions given)
        : options(std::move(given)),
          queue(jobs_of(options.commands.database), options.commands),
          context{options, queue, {}},
          server({.gate = [this](const http::Request& head) { return entrance->judge(head); },
                  .problem = problem,
                  .failure = failure,
                  .headers = safe_headers(),
                  .lanes = lane_limits()}) {}

    ServiceOptions options;
    std::atomic<bool> ending{false};
    JobQueue queue;
    RouteContext context;
    std::optional<Entrance> entrance;  // as soon as the port is known
    http::Server server;
};

Service::Service(ServiceOptions options) : parts_(std::make_unique<Parts>(std::move(options))) {
    parts_->options.commands.ending = &parts_->ending;
    http::Server& server = parts_->server;
    add_page_routes(server, parts_->context);
    for (const Route& route : api_routes(parts_->context))
        server.add(route.method == "get" ? "GET" : "POST", route.path, route.handler,
                   static_cast<std::size_t>(route.lane));
    Access& access = parts_->options.access;
    access.port = server.listen(access.host, access.port);
    parts_->entrance.emplace(access);
}

Service::~Service() = default;

int Service::port() const {
    return parts_->options.access.port;
}

void Service::run() {
    parts_->server.run();
}

void Service::stop() {
    parts_->ending = true;
    parts_->server.stop();
}

}  // namespace capstan::service
