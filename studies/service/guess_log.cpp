#include "capstan/service/guess_log.h"

#include <algorithm>

namespace capstan::service {

namespace {

constexpr std::chrono::milliseconds apart{500};
constexpr std::chrono::seconds longest_wait{5};
constexpr std::size_t max_addresses = 10'000;

}  // namespace

bool GuessLog::may_guess(const std::string& address, Clock::time_point now) const {
    const auto found = next_.find(address);
    return found == next_.end() || found->second - now < longest_wait;
}

std::chrono::milliseconds GuessLog::wrong(const std::string& address, Clock::time_point now) {
    std::erase_if(next_, [&](const auto& each) { return each.second < now; });
    if (next_.size() >= max_addresses) next_.erase(next_.begin());
    Clock::time_point& next = next_[address];
    next = std::max(next, now) + apart;
    return std::chrono::duration_cast<std::chrono::milliseconds>(next - now);
}

}  // namespace capstan::service
