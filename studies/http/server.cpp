#include "capstan/http/server.h"

#include <fmt/format.h>
#include <malloc.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <stdexcept>

#include "capstan/http/connection.h"

namespace capstan::http {

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Error = boost::system::error_code;

constexpr std::chrono::milliseconds between_looks{200};  // at connections whose time is up
constexpr std::chrono::milliseconds pause_without_files{100};
constexpr int trim_above_bytes = 1 << 20;
constexpr int map_above_bytes = 256 << 10;

// By default the C library gives many threads up to eight heaps for each processor, each of which grows to
// the size of the largest answers made in it, and learns to keep large blocks. Two heaps are enough for
// threads that mostly wait, and large blocks go back to the system at once.
void limit_heaps() {
    ::mallopt(M_ARENA_MAX, 2);
    ::mallopt(M_MMAP_THRESHOLD, map_above_bytes);
    ::mallopt(M_TRIM_THRESHOLD, trim_above_bytes);
}

// The network of an address of IPv6 counts: a client may have all addresses in it.
std::string name_of_client(const tcp::socket& socket) {
    Error gone;
    const auto end = socket.remote_endpoint(gone);
    if (gone) return "";
    asio::ip::address address = end.address();
    if (!address.is_v6()) return address.to_string();
    const asio::ip::address_v6 six = address.to_v6();
    if (six.is_v4_mapped()) return asio::ip::make_address_v4(asio::ip::v4_mapped, six).to_string();
    auto bytes = six.to_bytes();
    if (!six.is_loopback()) std::fill(bytes.begin() + 8, bytes.end(), static_cast<unsigned char>(0));
    return asio::ip::address_v6(bytes).to_string();
}

}  // namespace

struct Server::Parts {
    explicit Parts(ServerOptions given) : options(std::move(given)), exchange{options, {}} {
        for (const LaneLimits& lane : options.lanes)
            exchange.lanes.push_back(std::make_unique<WorkLane>(lane));
    }
    ~Parts() {
        exchange.lanes.clear();  // what is being answered still posts to the event loop
        exchange.connections.drop_all();
    }

    void accept();
    void watch();

    ServerOptions options;
    Exchange exchange;
    asio::io_context loop{1};
    tcp::acceptor acceptor{loop};
    asio::steady_timer clock{loop};
    asio::steady_timer pause{loop};
};

void Server::Parts::accept() {
    acceptor.async_accept([this](const Error& error, tcp::socket socket) {
        if (error == asio::error::operation_aborted) return;
        if (error) {  // no file descriptor is left
            exchange.connections.drop_one("");
            pause.expires_after(pause_without_files);
            pause.async_wait([this](const Error&) { accept(); });
            return;
        }
        std::string client = name_of_client(socket);
        auto connection = std::make_shared<Connection>(std::move(socket), std::move(client), exchange);
        if (exchange.connections.add(connection)) connection->start();
        accept();
    });
}

void Server::Parts::watch() {
    clock.expires_after(between_looks);
    clock.async_wait([this](const Error& error) {
        if (error) return;
        exchange.connections.drop_late();
        watch();
    });
}

Server::Server(ServerOptions options)
    : parts_((limit_heaps(), std::make_unique<Parts>(std::move(options)))) {}

Server::~Server() = default;

void Server::add(const std::string& method, std::string_view path, Handler handler, std::size_t lane) {
    parts_->exchange.routes.add(method, path, std::move(handler), lane);
}

int Server::listen(const std::string& host, int port) {
    tcp::acceptor& acceptor = parts_->acceptor;
    try {
        const auto found =
            tcp::resolver(parts_->loop).resolve(host, std::to_string(port), tcp::resolver::passive);
        const tcp::endpoint end = found.begin()->endpoint();
        acceptor.open(end.protocol());
        acceptor.set_option(tcp::acceptor::reuse_address(true));  // no second service may share the port
        acceptor.bind(end);
        acceptor.listen(tcp::acceptor::max_listen_connections);
    } catch (const boost::system::system_error& error) {
        throw std::runtime_error(
            fmt::format("cannot listen on {}, port {}: {}. Is the port taken? Try another --port", host, port,
                        error.code().message()));
    }
    return acceptor.local_endpoint().port();
}

void Server::run() {
    parts_->accept();
    parts_->watch();
    parts_->loop.run();
}

void Server::stop() {
    parts_->loop.stop();
}

}  // namespace capstan::http
