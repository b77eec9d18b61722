#include "capstan/service/report_shelf.h"

#include <algorithm>

namespace capstan::service {

namespace {

constexpr std::chrono::milliseconds moment{500};
constexpr std::size_t max_places = 32;  // of studies and questions that are looked at now
constexpr std::size_t max_bytes = 20'000'000;
constexpr std::size_t compressed_part = 4;       // of a text, its compressed form: at most a fourth
constexpr std::size_t largest_kept = 4'000'000;  // the report of 100,000 cells has 3.5 million

}  // namespace

std::shared_ptr<ReportShelf::Place> ReportShelf::place(const std::string& name) {
    const std::lock_guard lock(mutex_);
    Entry& entry = places_[name];
    if (!entry.place) entry.place = std::make_shared<Place>();
    entry.asked = ++asked_;
    std::shared_ptr<Place> place = entry.place;
    drop_the_oldest();
    return place;
}

// For a text that is about to be stored. A dropped text lives on while somebody reads it.
void ReportShelf::make_room(const std::string& name, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    const auto own = places_.find(name);
    if (own == places_.end()) return;
    own->second.bytes = bytes;
    own->second.asked = ++asked_;
    drop_the_oldest();
}

void ReportShelf::drop_the_oldest() {
    std::size_t bytes = 0;
    for (const auto& [name, entry] : places_) bytes += entry.bytes;
    while (places_.size() > max_places || bytes > max_bytes) {
        const auto oldest =
            std::ranges::min_element(places_, {}, [](const auto& named) { return named.second.asked; });
        bytes -= oldest->second.bytes;
        places_.erase(oldest);
    }
}

std::shared_ptr<const http::KeptText> ReportShelf::get(const std::string& name, const std::string& state,
                                                       Freshness freshness, const Maker& make) {
    const auto kept = place(name);
    const auto look = [&](Clock::duration age) -> std::shared_ptr<const http::KeptText> {
        const std::lock_guard lock(kept->reading);
        if (kept->state == state) return kept->text;
        const bool will_do = freshness != Freshness::exact && Clock::now() - kept->made < age;
        return will_do ? kept->text : nullptr;
    };
    if (auto text = look(moment)) return text;
    std::unique_lock making(kept->making, std::try_to_lock);
    if (!making) {
        if (freshness == Freshness::a_moment_old) {
            if (auto text = look(Clock::duration::max())) return text;
        }
        making.lock();
    }
    if (auto text = look(moment)) return text;  // made while this one waited
    auto text = std::make_shared<const http::KeptText>(make());
    const std::size_t bytes = text->plain().size();
    if (bytes > largest_kept) return text;
    make_room(name, bytes + bytes / compressed_part);
    const std::lock_guard lock(kept->reading);
    kept->text = text;
    kept->state = state;
    kept->made = Clock::now();
    return text;
}

}  // namespace capstan::service
