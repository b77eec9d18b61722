#include "capstan/service/service.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/socket.h>

#include <atomic>
#include <charconv>

#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"
#include "capstan/storage/error.h"

namespace capstan::service {

namespace {

constexpr int request_threads = 64;  // they mostly wait; more people than that queue
constexpr int patience_s = 10;       // for a slow sender or reader

// Left to itself, the C library gives 64 threads up to eight heaps for each processor, and each grows as far
// as the largest answers that happened to be made in it. Two are enough for threads that mostly wait, and
// soon as large as they get.
void fraction_memory_among_threads() {
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
        const bool whole = error == std::errc() && end == length.data() + length.size();
        head.content_length = whole ? bytes : static_cast<std::size_t>(-1);
    }
    return head;
}

// Nothing but what this service sends may run or be loaded by its pages, and nobody may frame them. The
// charts compile their expressions, which needs 'unsafe-eval'.
const httplib::Headers safe_headers{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; connect-src 'self'; "
     "img-src 'self' data: blob:; form-action 'self'; base-uri 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
};

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
    fraction_memory_among_threads();
    httplib::Server& server = parts_->server;
    Access& access = parts_->options.access;
    server.new_task_queue = [] { return new httplib::ThreadPool(request_threads); };
    // One request a connection: nobody holds a thread while idle, and what follows a refused head is never
    // taken for another request.
    server.set_keep_alive_max_count(1);
    server.set_read_timeout(patience_s);
    server.set_write_timeout(patience_s);
    server.set_payload_max_length(largest_upload_bytes);
    server.set_socket_options([this](socket_t socket) {  // the port is ours alone
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
    add_study_routes(server, parts_->context);
    add_layout_routes(server, parts_->context);
    add_job_routes(server, parts_->context);
    add_diagnosis_routes(server, parts_->context);
    add_query_routes(server, parts_->context);

    if (access.port == 0) {
        access.port = server.bind_to_any_port(access.host);
    } else if (!server.bind_to_port(access.host, access.port)) {
        access.port = -1;
    }
    if (access.port < 0)
        throw std::runtime_error(fmt::format("cannot listen on {}: is the port taken? Try another --port",
                                             parts_->options.access.host));
    // The library lets five wait to be accepted; who comes sixth at the same moment would wait for a second.
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
