#include "capstan/http/connection.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/status.hpp>
#include <cctype>
#include <limits>

#include "capstan/http/head_rules.h"
#include "capstan/http/multipart.h"
#include "capstan/http/target.h"

namespace capstan::http {

namespace {

namespace asio = boost::asio;
namespace beast_http = boost::beast::http;

constexpr std::chrono::seconds linger_time{2};
constexpr std::size_t max_discarded = 1 << 20;
constexpr std::size_t charged_at_once = 1 << 20;  // of the memory limit

std::string_view view_of(boost::beast::string_view text) {
    return {text.data(), text.size()};
}

std::string_view reason_of(int status) {
    const auto words = beast_http::obsolete_reason(beast_http::int_to_status(static_cast<unsigned>(status)));
    return {words.data(), words.size()};
}

std::chrono::milliseconds time_for(std::size_t bytes, const ServerLimits& limits) {
    return limits.body_time + std::chrono::milliseconds(bytes * 1000 / limits.slowest_bytes_per_s);
}

}  // namespace

Connection::Connection(Socket socket, std::string address, Exchange& exchange)
    : socket_(std::move(socket)),
      address_(std::move(address)),
      exchange_(exchange),
      delay_(socket_.get_executor()),
      buffer_(exchange.options.limits.head_bytes + 1024) {
    parser_.header_limit(static_cast<std::uint32_t>(exchange.options.limits.head_bytes));
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());  // head_rules looks at it
}

Connection::~Connection() {
    exchange_.memory.give_back(held_);
}

void Connection::start() {
    set_deadline(exchange_.options.limits.head_time);
    read_head();
}

void Connection::close() {
    Error ignored;
    delay_.cancel(ignored);
    socket_.close(ignored);
    exchange_.connections.remove(*this);
}

bool Connection::hold(std::size_t bytes) {
    if (!exchange_.memory.take(bytes)) return false;
    held_ += bytes;
    return true;
}

void Connection::read_head() {
    beast_http::async_read_header(socket_, buffer_, parser_,
                                  [self = shared_from_this()](const Error& error, std::size_t) {
                                      if (error) return self->explain_head(error);
                                      self->judge();
                                  });
}

void Connection::explain_head(const Error& error) {
    const bool too_long =
        error == beast_http::error::header_limit || error == beast_http::error::buffer_overflow;
    if (too_long) {
        // Of a request line that fills the buffer nothing was read.
        if (parser_.get().target().empty()) return refuse(414, "The address is too long.");
        return refuse(431, fmt::format("The head of the request is longer than {} bytes.",
                                       exchange_.options.limits.head_bytes));
    }
    if (error.category() != beast_http::make_error_code(beast_http::error::bad_method).category() ||
        error == beast_http::error::end_of_stream || error == beast_http::error::partial_message)
        return close();
    refuse(400, "The request is not HTTP/1.1: " + error.message() + ".");
}

void Connection::judge() {
    const auto& head = parser_.get();
    const auto method = head.method_string();
    request_.method.assign(method.data(), method.size());
    request_.client = address_;
    for (const auto& field : head) {
        const auto value = field.value();
        request_.headers.emplace_back(lower_case(view_of(field.name_string())),
                                      std::string(value.data(), value.size()));
    }
    if (const auto length = parser_.content_length(); length)
        request_.content_length = static_cast<std::size_t>(
            std::min<std::uint64_t>(*length, std::numeric_limits<std::size_t>::max()));
    if (const auto problem = problem_of(request_, exchange_.options.limits))
        return refuse(problem->status, problem->message);
    const auto text = head.target();
    auto target = parse_target({text.data(), text.size()});
    if (!target) return refuse(400, "The address of the request is damaged.");
    request_.path = std::move(target->path);
    request_.parameters = std::move(target->parameters);
    Verdict verdict = exchange_.options.gate(request_);
    if (verdict.refusal) {
        if (verdict.delay.count() == 0) return send(std::move(*verdict.refusal));
        stage_ = Stage::delayed;
        set_deadline(verdict.delay + exchange_.options.limits.head_time);
        delay_.expires_after(verdict.delay);
        delay_.async_wait(
            [self = shared_from_this(), refusal = std::move(*verdict.refusal)](const Error& error) {
                if (!error) self->send(refusal);
            });
        return;
    }
    route_ = exchange_.routes.find(request_.method, request_.path);
    if (route_.entry == nullptr)
        return refuse(route_.other_method ? 405 : 404, fmt::format("{} {}", request_.method, request_.path));
    invite_body();
}

void Connection::invite_body() {
    const std::size_t length = request_.content_length.value_or(0);
    begun_ = Clock::now();
    set_deadline(exchange_.options.limits.body_time);
    const std::size_t there = std::min(buffer_.size(), length);
    request_.body.assign(static_cast<const char*>(buffer_.data().data()), there);
    if (there == length || request_.header("expect").empty()) return take_body(0);
    static constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
    asio::async_write(socket_, asio::buffer(go_on),
                      [self = shared_from_this()](const Error& error, std::size_t) {
                          if (error) return self->close();
                          self->take_body(0);
                      });
}

void Connection::read_body() {
    const std::size_t missing = *request_.content_length - request_.body.size();
    socket_.async_read_some(asio::buffer(received_.data(), std::min(received_.size(), missing)),
                            [self = shared_from_this()](const Error& error, std::size_t bytes) {
                                if (error) return self->close();
                                self->take_body(bytes);
                            });
}

void Connection::take_body(std::size_t bytes) {
    const std::size_t length = request_.content_length.value_or(0);
    std::string& body = request_.body;
    if (body.size() + bytes > held_ && !hold(std::min(charged_at_once, length)))
        return refuse(503, "The service is receiving too much at once; try again in a moment.");
    if (body.size() > charged_at_once) body.reserve(length);  // a client that sends one byte gets no more
    body.append(received_.data(), bytes);
    if (body.size() == length) return dispatch();
    deadline_ = begun_ + time_for(body.size(), exchange_.options.limits);
    read_body();
}

void Connection::dispatch() {
    request_.path_values = std::move(route_.path_values);
    stage_ = Stage::answering;
    const auto task = [self = shared_from_this()](WorkLane::Turn turn) {
        Response response = self->answer(turn == WorkLane::Turn::now);
        asio::post(self->socket_.get_executor(),
                   [self, response = std::move(response)]() mutable { self->send(std::move(response)); });
    };
    if (!exchange_.lanes[route_.entry->lane]->submit(task))
        refuse(503, "Too many requests of this kind at once; try again in a moment.");
}

// In a thread of the lane.
Response Connection::answer(bool in_time) {
    try {
        if (!in_time)
            return exchange_.options.problem(503,
                                             "too many requests of this kind at once; try again in a moment");
        if (request_.header("content-type").starts_with("multipart/form-data")) {
            auto parts = parse_form(request_.header("content-type"), request_.body);
            if (!parts) return exchange_.options.problem(400, "the form (multipart/form-data) is damaged");
            request_.parts = std::move(*parts);
        }
        Response response;
        route_.entry->handler(request_, response);
        if (response.is_kept && accepts_gzip(request_)) response.text->gzip();  // not in the event loop
        return response;
    } catch (...) {
        return exchange_.options.failure(std::current_exception());
    }
}

void Connection::refuse(int status, const std::string& message) {
    send(exchange_.options.problem(status, message));
}

void Connection::send(Response response) {
    stage_ = Stage::sending;
    std::string().swap(request_.body);
    exchange_.memory.give_back(std::exchange(held_, 0));
    if (!response.is_kept && response.text && !hold(response.text->plain().size()))
        response =
            exchange_.options.problem(503, "too many answers are being sent at once; try again in a moment");
    text_ = std::move(response.text);
    head_ = fmt::format("HTTP/1.1 {} {}\r\n", response.status, reason_of(response.status));
    if (text_) {
        body_ = text_->plain();
        head_ += fmt::format("Content-Type: {}\r\n", response.content_type);
        if (response.is_kept) head_ += "Vary: Accept-Encoding\r\n";
        if (response.is_kept && accepts_gzip(request_) && !text_->gzip().empty()) {
            body_ = text_->gzip();
            head_ += "Content-Encoding: gzip\r\n";
        }
    }
    for (const auto& [name, value] : response.headers) head_ += fmt::format("{}: {}\r\n", name, value);
    for (const auto& [name, value] : exchange_.options.headers)
        if (!response.has_header(name)) head_ += fmt::format("{}: {}\r\n", name, value);
    constexpr int not_modified = 304;  // whose length would be that of the text which is not sent
    if (response.status != not_modified) head_ += fmt::format("Content-Length: {}\r\n", body_.size());
    head_ += "Connection: close\r\n\r\n";
    if (request_.method == "HEAD") body_ = {};
    begun_ = Clock::now();
    send_more();
}

void Connection::send_more() {
    const std::size_t total = head_.size() + body_.size();
    if (sent_ == total) return linger();
    deadline_ = begun_ + time_for(sent_, exchange_.options.limits);
    const std::size_t of_head = std::min(sent_, head_.size());
    const std::size_t of_body = sent_ - of_head;
    const std::array<asio::const_buffer, 2> rest{
        asio::buffer(head_.data() + of_head, head_.size() - of_head),
        asio::buffer(body_.data() + of_body, body_.size() - of_body)};
    socket_.async_write_some(rest, [self = shared_from_this()](const Error& error, std::size_t bytes) {
        if (error) return self->close();
        self->sent_ += bytes;
        self->send_more();
    });
}

// A connection that is closed while bytes of its client are unread is reset, and the client may lose the
// answer. So what still comes is thrown away for a moment.
void Connection::linger() {
    stage_ = Stage::lingering;
    text_.reset();
    exchange_.memory.give_back(std::exchange(held_, 0));
    set_deadline(linger_time);
    Error ignored;
    socket_.shutdown(Socket::shutdown_send, ignored);
    discard();
}

void Connection::discard() {
    socket_.async_read_some(asio::buffer(received_),
                            [self = shared_from_this()](const Error& error, std::size_t bytes) {
                                self->discarded_ += bytes;
                                if (error || self->discarded_ > max_discarded) return self->close();
                                self->discard();
                            });
}

}  // namespace capstan::http
