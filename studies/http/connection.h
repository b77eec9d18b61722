#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "capstan/http/connection_list.h"
#include "capstan/http/memory_limit.h"
#include "capstan/http/route_table.h"
#include "capstan/http/server.h"

namespace capstan::http {

/// What all connections share.
struct Exchange {
    const ServerOptions& options;
    RouteTable routes;
    std::vector<std::unique_ptr<WorkLane>> lanes{};
    MemoryLimit memory{options.limits.bytes_in_memory};
    ConnectionList connections{options.limits};
};

/// One connection and its one request, in this order: read the head, judge it, read the body, answer in a
/// lane, send. All but the answering happens in the thread of the event loop.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    using Clock = std::chrono::steady_clock;
    using Socket = boost::asio::ip::tcp::socket;
    using Error = boost::system::error_code;

    Connection(Socket socket, std::string address, Exchange& exchange);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void start();
    void close();

    const std::string& address() const { return address_; }
    bool is_late(Clock::time_point now) const { return stage_ != Stage::answering && now > deadline_; }
    /// A newer connection may take its place.
    bool waits_for_client() const { return stage_ != Stage::answering && stage_ != Stage::sending; }

  private:
    enum class Stage { reading, answering, delayed, sending, lingering };

    void read_head();
    void explain_head(const Error& error);
    void judge();
    void invite_body();
    void read_body();
    void take_body(std::size_t bytes);
    void dispatch();
    Response answer(bool in_time);
    void refuse(int status, const std::string& message);
    void send(Response response);
    void send_more();
    void linger();
    void discard();
    bool hold(std::size_t bytes);
    void set_deadline(Clock::duration time) { deadline_ = Clock::now() + time; }

    Socket socket_;
    std::string address_;
    Exchange& exchange_;
    Stage stage_ = Stage::reading;
    Clock::time_point deadline_{};
    Clock::time_point begun_{};  // of the body, or of sending
    boost::asio::steady_timer delay_;
    boost::beast::flat_buffer buffer_;
    boost::beast::http::request_parser<boost::beast::http::empty_body> parser_;
    std::array<char, 16384> received_;
    Request request_;
    RouteTable::Found route_;
    std::string head_;
    std::shared_ptr<const KeptText> text_;
    std::string_view body_;  // of the answer, in `text_`
    std::size_t sent_ = 0;   // of head_ and body_
    std::size_t held_ = 0;   // of the memory limit
    std::size_t discarded_ = 0;
};

}  // namespace capstan::http
