#include "capstan/service/report_shelf.h"

namespace capstan::service {

namespace {

constexpr std::chrono::milliseconds moment{500};
constexpr std::size_t most_places = 64;  // of studies and questions looked at
constexpr std::size_t largest_kept = 4'000'000;

}  // namespace

std::shared_ptr<ReportShelf::Place> ReportShelf::place(const std::string& name) {
    const std::lock_guard lock(mutex_);
    if (places_.size() >= most_places && places_.count(name) == 0) places_.clear();
    auto& place = places_[name];
    if (!place) place = std::make_shared<Place>();
    return place;
}

std::shared_ptr<const std::string> ReportShelf::get(const std::string& name, const std::string& state,
                                                    Freshness freshness, const Maker& make) {
    const auto kept = place(name);
    const auto look = [&](Clock::duration age) -> std::shared_ptr<const std::string> {
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
    auto text = std::make_shared<const std::string>(make());
    if (text->size() > largest_kept) return text;
    const std::lock_guard lock(kept->reading);
    kept->text = text;
    kept->state = state;
    kept->made = Clock::now();
    return text;
}

}  // namespace capstan::service
