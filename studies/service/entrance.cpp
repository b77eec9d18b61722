#include "capstan/service/entrance.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "capstan/service/exchange.h"

namespace capstan::service {

namespace {

constexpr std::string_view bearer = "Bearer ";
constexpr std::chrono::milliseconds guesses_apart{500};
constexpr std::chrono::seconds longest_wait{5};
constexpr std::size_t max_addresses = 10'000;

std::string field(const http::Request& head, std::string_view name) {
    return std::string(head.header(name));
}

RequestHead head_of(const http::Request& head) {
    return {head.method,
            head.path,
            field(head, "host"),
            field(head, "origin"),
            field(head, "sec-fetch-site"),
            field(head, "content-type"),
            field(head, "transfer-encoding"),
            head.content_length};
}

http::Verdict refusal(int status, const std::string& message) {
    http::Verdict verdict;
    send_error(verdict.refusal.emplace(), status, message);
    return verdict;
}

std::int64_t now_s() {
    return std::chrono::duration_cast<std::chrono::seconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

}  // namespace

bool GuessLog::may_guess(const std::string& address, Clock::time_point now) const {
    const auto found = next_.find(address);
    return found == next_.end() || found->second - now < longest_wait;
}

std::chrono::milliseconds GuessLog::wrong(const std::string& address, Clock::time_point now) {
    std::erase_if(next_, [&](const auto& each) { return each.second < now; });
    if (next_.size() >= max_addresses) next_.erase(next_.begin());
    Clock::time_point& next = next_[address];
    next = std::max(next, now) + guesses_apart;
    return std::chrono::duration_cast<std::chrono::milliseconds>(next - now);
}

http::Verdict Entrance::judge(const http::Request& head) {
    const RequestHead request = head_of(head);
    if (const auto problem = refuse_origin(request, access_))
        return refusal(problem->status, problem->message);
    if (!access_.token.empty()) {
        if (http::Verdict verdict = judge_token(head); verdict.refusal) return verdict;
    }
    if (const auto problem = refuse_body(request)) return refusal(problem->status, problem->message);
    return {};
}

http::Verdict Entrance::judge_token(const http::Request& head) {
    const auto in_address = head.parameters.find("token");
    const bool enters = head.method == "GET" && head.path == "/" && in_address != head.parameters.end();
    const std::string_view shown = head.header("authorization");
    if (!enters && shown.empty()) {
        if (sessions_.is_valid(head.header("cookie"), now_s())) return {};
        return refusal(
            401,
            "The token is missing, or the session has ended: open the address that `capstan serve` "
            "printed, or send the header 'Authorization: Bearer TOKEN'.");
    }
    if (!guesses_.may_guess(head.client, GuessLog::Clock::now()))
        return refusal(429, "Too many wrong tokens came from this address; try again in a few seconds.");
    if (!enters) {
        const bool is_ours =
            shown.starts_with(bearer) && same_secret(shown.substr(bearer.size()), access_.token);
        return is_ours ? http::Verdict{} : refuse_guess(head);
    }
    if (!same_secret(in_address->second, access_.token)) return refuse_guess(head);
    http::Verdict verdict;
    http::Response& front_page = verdict.refusal.emplace();
    front_page.status = 303;
    front_page.add_header("Location", "/");
    front_page.add_header("Set-Cookie",
                          fmt::format("{}={}; Max-Age={}; HttpOnly; SameSite=Strict; Path=/",
                                      sessions_.cookie_name(), sessions_.begin(now_s()), session_s));
    return verdict;
}

http::Verdict Entrance::refuse_guess(const http::Request& head) {
    http::Verdict verdict =
        refusal(401,
                "The token is wrong: open the address that `capstan serve` printed, or send the header "
                "'Authorization: Bearer TOKEN'.");
    verdict.delay = guesses_.wrong(head.client, GuessLog::Clock::now());
    return verdict;
}

}  // namespace capstan::service
