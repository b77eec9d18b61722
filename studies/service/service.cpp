#include "capstan/service/service.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/socket.h>

#include <atomic>
#include <charconv>
#include <regex>

#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/storage/error.h"

namespace capstan::service {

namespace {

constexpr int request_threads = 64;  // they mostly wait; further requests queue
constexpr int patience_s = 10;       // for a slow sender or reader

// By default the C library gives 64 threads up to eight heaps for each processor, and each heap grows to the
// size of the largest answers made in it. Two heaps are enough for threads that mostly wait.
void limit_heaps() {
    ::mallopt(M_ARENA_MAX, 2);
}

RequestHead head_of(const httplib::Request& request) {
    RequestHead head{request.method,
                     request.path,
                     request.get_header_value("Host"),
                     request.get_header_value("Origin"),
                     request.get_header_value("Sec-Fetch-Site"),
                     request.get_header_value("Authorization"),
                     request.get_header_value("Cookie"),
                     request.get_header_value("Content-Type"),
                     request.get_header_value("Transfer-Encoding"),
                     {}};
    const std::string length = request.get_header_value("Content-Length");
    std::size_t bytes = 0;
    const auto [end, error] = std::from_chars(length.data(), length.data() + length.size(), bytes);
    if (!length.empty()) {
        const bool is_integer = error == std::errc() && end == length.data() + length.size();
        head.content_length = is_integer ? bytes : static_cast<std::size_t>(-1);
    }
    return head;
}

// The pages run and load only files of this service, and no other page can frame them. The charts compile
// their expressions, which needs 'unsafe-eval'.
const httplib::Headers safe_headers{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; connect-src 'self'; "
     "img-src 'self' data: blob:; form-action 'self'; base-uri 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
};

// /api/jobs/{job} as the regular expression that the server matches.
std::string pattern_of(const std::string& path) {
    const std::regex name(R"(\{name\})"), number(R"(\{\w+\})");
    return std::regex_replace(std::regex_replace(path, name, "([^/]+)"), number, R"((\d+))");
}

void add_route(httplib::Server& server, const Route& route) {
    if (route.method == "get")
        server.Get(pattern_of(route.path), route.handler);
    else
        server.Post(pattern_of(route.path), route.handler);
}

void explain(httplib::Response& response, const std::exception_ptr& problem) {
    try {
        std::rethrow_exception(problem);
    } catch (const BadRequest& error) {
        send_error(response, error.status(), error.what());
    } catch (const std::exception& error) {
        send_error(response, 500, error.what());
    } catch (...) {
        send_error(response, 500, "unknown problem");
    }
}

}  // namespace

struct Service::Parts {
    explicit Parts(ServiceOptions given)
        : options(std::move(given)),
          queue(options.commands.database + ".jobs", options.commands),
          context{options, queue, {}} {}

    ServiceOptions options;
    JobQueue queue;
    RouteContext context;
    httplib::Server server;
    socket_t listening = INVALID_SOCKET;
};

Service::Service(ServiceOptions options) : parts_(std::make_unique<Parts>(std::move(options))) {
    limit_heaps();
    httplib::Server& server = parts_->server;
    Access& access = parts_->options.access;
    server.new_task_queue = [] { return new httplib::ThreadPool(request_threads); };
    // One request per connection: no idle client holds a thread, and the bytes after a rejected head are
    // never read as another request.
    server.set_keep_alive_max_count(1);
    server.set_read_timeout(patience_s);
    server.set_write_timeout(patience_s);
    server.set_payload_max_length(largest_upload_bytes);
    server.set_socket_options([this](socket_t socket) {  // no second service may share the port
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        parts_->listening = socket;
    });
    server.set_default_headers(safe_headers);
    server.set_expect_100_continue_handler([&access](const httplib::Request& request, httplib::Response&) {
        const auto refusal = refuse(head_of(request), access);
        return refusal ? refusal->status : 100;
    });
    server.set_pre_routing_handler([&access](const httplib::Request& request, httplib::Response& response) {
        // The front page takes the token from its address, once.
        const bool enters = request.method == "GET" && request.path == "/" && request.has_param("token");
        const auto refusal = refuse(head_of(request), access);
        if (!refusal || (enters && refusal->status == 401))
            return httplib::Server::HandlerResponse::Unhandled;
        send_error(response, refusal->status, refusal->message);
        return httplib::Server::HandlerResponse::Handled;
    });
    server.set_exception_handler([](const httplib::Request&, httplib::Response& response,
                                    const std::exception_ptr& problem) { explain(response, problem); });
    server.set_error_handler([](const httplib::Request& request, httplib::Response& response) {
        if (response.body.empty())
            send_error(response, response.status, fmt::format("{} {}", request.method, request.path));
    });
    add_page_routes(server, parts_->context);
    for (const Route& route : api_routes(parts_->context)) add_route(server, route);

    if (access.port == 0) {
        access.port = server.bind_to_any_port(access.host);
    } else if (!server.bind_to_port(access.host, access.port)) {
        access.port = -1;
    }
    if (access.port < 0)
        throw std::runtime_error(fmt::format("cannot listen on {}: is the port taken? Try another --port",
                                             parts_->options.access.host));
    // By default the library lets five connections wait; a sixth would be delayed by a second.
    ::listen(parts_->listening, SOMAXCONN);
}

Service::~Service() = default;

int Service::port() const {
    return parts_->options.access.port;
}

void Service::run() {
    parts_->server.listen_after_bind();
}

bool Service::stop() {
    if (!parts_->server.is_running()) return false;
    parts_->server.stop();
    return true;
}

}  // namespace capstan::service
