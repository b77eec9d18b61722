#include "capstan/worlds/candidate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "capstan/cable/cable_cut.h"
#include "capstan/worlds/sensor_places.h"
#include "capstan/worlds/set_constraints.h"

namespace capstan {

namespace {

// Sensors by kind: where a family may put tension sensors, and what else can be bought.
struct Shelf {
    std::array<std::vector<int>, 2> along;  // tension sensors of each cable, by place
    std::vector<int> others;
};

Shelf shelf_of(const std::vector<SensorOffer>& offers) {
    Shelf shelf;
    for (std::size_t k = 0; k < offers.size(); ++k) {
        std::vector<int>& along = shelf.along[static_cast<std::size_t>(offers[k].cable)];
        (offers[k].kind == SensorKind::tension ? along : shelf.others).push_back(static_cast<int>(k));
    }
    for (std::vector<int>& along : shelf.along)
        std::stable_sort(along.begin(), along.end(),
                         [&](int a, int b) { return offers[a].place_m < offers[b].place_m; });
    return shelf;
}

// The places closest to those evenly spread from the first to the last one; a single one in the middle.
std::vector<int> evenly_spread(int count, const std::vector<double>& places_m) {
    std::vector<int> chosen;
    const double span_m = places_m.back() - places_m.front();
    const auto places = static_cast<int>(places_m.size());
    for (int k = 0; k < count; ++k) {
        const double at_m = places_m.front() + span_m * (count == 1 ? 0.5 : k / (count - 1.0));
        const auto away_m = [&](int place) {
            return std::abs(places_m[static_cast<std::size_t>(place)] - at_m);
        };
        int best = chosen.empty() ? 0 : chosen.back() + 1;
        const int last = places - (count - k);  // leaves a place for each that follows
        for (int place = best + 1; place <= last; ++place)
            if (away_m(place) <= away_m(best) + same_place_m) best = place;
        chosen.push_back(best);
    }
    return chosen;
}

std::vector<std::vector<int>> family_sets(const std::string& family, int count,
                                          const std::vector<double>& places_m) {
    if (family == "even") return {evenly_spread(count, places_m)};
    std::vector<std::vector<int>> sets;
    const LayoutFamily* found = find_layout_family(family);
    if (found == nullptr) return sets;
    for (const Layout& layout : found->layouts(count, static_cast<int>(places_m.size())))
        sets.push_back(layout.nodes);
    return sets;
}

// Sets by their sensors, each with all its names.
using NamedSets = std::map<std::vector<int>, std::vector<std::string>>;

void add(NamedSets& sets, std::vector<int> sensors, const std::string& name) {
    std::sort(sensors.begin(), sensors.end());
    auto& names = sets[sensors];
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

// The named sets of tension sensors on one cable, in the order of their making: `along` are its sensors.
std::vector<std::pair<std::string, std::vector<int>>> sets_along(const StudyPlan& plan,
                                                                 const std::vector<SensorOffer>& offers,
                                                                 const std::vector<int>& along) {
    std::vector<std::pair<std::string, std::vector<int>>> sets;
    const int places = static_cast<int>(along.size());
    std::vector<double> places_m;
    for (const int sensor : along) places_m.push_back(offers[static_cast<std::size_t>(sensor)].place_m);
    const auto take = [&](const std::string& name, const std::vector<int>& chosen) {
        sets.push_back({name, {}});
        for (const int place : chosen)
            if (place < places) sets.back().second.push_back(along[static_cast<std::size_t>(place)]);
    };
    for (const std::string& family : plan.layout_families) {
        for (const int count : plan.sensor_counts) {
            if (count > places) continue;
            for (const std::vector<int>& set : family_sets(family, count, places_m)) take(family, set);
        }
    }
    for (const std::vector<int>& nodes : plan.explicit_layouts) take("explicit", nodes);
    return sets;
}

NamedSets named_sets(const StudyPlan& plan, const std::vector<SensorOffer>& offers) {
    const Shelf shelf = shelf_of(offers);
    NamedSets along;
    const auto on_a = sets_along(plan, offers, shelf.along[0]);
    const auto on_b = sets_along(plan, offers, shelf.along[1]);
    for (const auto& [name, sensors] : on_a) add(along, sensors, name);
    for (const auto& [name, sensors] : on_b) add(along, sensors, name);
    // The same on both cables of a pair.
    for (std::size_t k = 0; k < std::min(on_a.size(), on_b.size()); ++k) {
        std::vector<int> both = on_a[k].second;
        both.insert(both.end(), on_b[k].second.begin(), on_b[k].second.end());
        if (on_a.size() == on_b.size()) add(along, both, on_a[k].first);
    }
    add(along, {}, "");
    // With each set of tension sensors every selection of the other sensors.
    NamedSets sets;
    const auto selections = std::size_t{1} << std::min<std::size_t>(shelf.others.size(), 10);
    for (const auto& [sensors, names] : along) {
        for (std::size_t bits = 0; bits < selections; ++bits) {
            std::vector<int> all = sensors;
            for (std::size_t k = 0; k < shelf.others.size(); ++k)
                if ((bits >> k & 1) != 0) all.push_back(shelf.others[k]);
            if (names.empty()) add(sets, all, "");
            for (const std::string& name : names) add(sets, all, name);
        }
    }
    return sets;
}

// All sets that `constraints` allow; nothing where there are more than `max_candidates`.
class AllSets {
  public:
    AllSets(const SetConstraints& constraints, int offers) : constraints_(constraints), offers_(offers) {}

    std::optional<std::vector<std::vector<int>>> find() {
        std::vector<int> none;
        if (!grow(none, 0)) return std::nullopt;
        return std::move(sets_);
    }

  private:
    // Every set that begins with `sensors` and goes on with offers from `from`; false where there are too
    // many.
    bool grow(std::vector<int>& sensors, int from) {
        for (int next = from; next < offers_; ++next) {
            sensors.push_back(next);
            if (constraints_.may_grow(sensors)) {
                if (constraints_.allow(sensors)) sets_.push_back(sensors);
                if (sets_.size() > max_candidates || !grow(sensors, next + 1)) return false;
            }
            sensors.pop_back();
        }
        return true;
    }

    const SetConstraints& constraints_;
    int offers_;
    std::vector<std::vector<int>> sets_;
};

}  // namespace

std::vector<Candidate> candidates_of(const StudyPlan& plan, const std::vector<SensorOffer>& offers) {
    const SetConstraints constraints(plan, offers);
    NamedSets sets = named_sets(plan, offers);
    std::erase_if(sets, [&](const auto& set) { return set.first.empty() || !constraints.allow(set.first); });
    bool is_greedy = plan.placement.search == ComparedSets::greedy;
    if (plan.placement.search == ComparedSets::all) {
        const auto all = AllSets(constraints, static_cast<int>(offers.size())).find();
        is_greedy = !all;
        for (const std::vector<int>& set : all.value_or(std::vector<std::vector<int>>{})) add(sets, set, "");
    }
    if (is_greedy) {
        if (const auto required = constraints.fewest(); required && !required->empty())
            add(sets, *required, "");
        for (const int sensor : constraints.usable())
            if (constraints.allow({sensor})) add(sets, {sensor}, "");
    }
    if (sets.empty())
        throw InvalidInput(std::vector<KeyProblem>{
            {"placement",
             "no set of sensors satisfies all constraints; relax one, or offer more in [[sensor]] or [layouts]"}});
    std::vector<Candidate> candidates = {{}};
    for (auto& [sensors, names] : sets) candidates.push_back({sensors, names, price_of(sensors, offers)});
    std::stable_sort(candidates.begin() + 1, candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::pair(a.price, a.count()) < std::pair(b.price, b.count());
    });
    if (is_greedy) {
        const std::vector<int> all = constraints.usable();
        candidates.push_back({all, {}, price_of(all, offers), true});
    }
    return candidates;
}

double price_of(const std::vector<int>& sensors, const std::vector<SensorOffer>& offers) {
    double price = 0.0;
    for (const int sensor : sensors) price += offers[static_cast<std::size_t>(sensor)].price;
    return price;
}

std::string words_of(const Candidate& candidate, const std::vector<SensorOffer>& offers) {
    if (candidate.sensors.empty()) return "no sensor";
    std::array<std::vector<std::string>, 2> along;  // places on each cable
    std::vector<std::string> parts;
    for (const int sensor : candidate.sensors) {
        const SensorOffer& offer = offers[static_cast<std::size_t>(sensor)];
        if (offer.kind == SensorKind::tension) {
            along[static_cast<std::size_t>(offer.cable)].push_back(fmt::format("{:.3g}", offer.place_m));
        } else {
            parts.push_back(words_of(offer));
        }
    }
    const bool names_cable = has_two_cables(offers);
    for (const int cable : {1, 0}) {
        std::vector<std::string>& places = along[static_cast<std::size_t>(cable)];
        if (places.empty()) continue;
        const std::string last = places.back();
        places.pop_back();
        const std::string at =
            places.empty() ? last : fmt::format("{} and {}", fmt::join(places, ", "), last);
        const std::string_view of = !names_cable ? "" : cable == 0 ? " of cable A" : " of cable B";
        parts.insert(parts.begin(), fmt::format("tension at {} m{}", at, of));
    }
    return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace capstan
