#include "capstan/worlds/candidate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "capstan/worlds/sensor_places.h"

namespace capstan {

namespace {

// Two places closer than this are one.
constexpr double same_place_m = 1e-6;

double price_of(const std::vector<int>& sensors, const std::vector<SensorOffer>& offers) {
    double price = 0.0;
    for (const int sensor : sensors) price += offers[static_cast<std::size_t>(sensor)].price;
    return price;
}

// What [placement] says of a set of sensors. Nodes of the constraints stand for their places.
class Constraints {
  public:
    Constraints(const StudyPlan& plan, const std::vector<SensorOffer>& offers)
        : plan_(plan.placement), offers_(offers) {
        for (const CurvaturePiece& piece : plan.transmission.cable.curvature) length_m_ += piece.length_m;
        segment_m_ = length_m_ / plan.transmission.cable.segments;
    }

    bool allow(const std::vector<int>& sensors) const {
        return may_grow(sensors) && has_all_required(sensors);
    }

    // Whether a set breaks nothing that more sensors could not put right.
    bool may_grow(const std::vector<int>& sensors) const {
        if (static_cast<int>(sensors.size()) > plan_.max_sensors) return false;
        if (price_of(sensors, offers_) > plan_.budget * (1.0 + 1e-12)) return false;
        int in_distal_half = 0;
        std::vector<double> places_m;
        for (const int sensor : sensors) {
            const SensorOffer& offer = offers_[static_cast<std::size_t>(sensor)];
            if (is_forbidden(offer)) return false;
            if (offer.place_m > 0.5 * length_m_ + same_place_m) ++in_distal_half;
            if (offer.kind == SensorKind::tension) places_m.push_back(offer.place_m);
        }
        if (in_distal_half > plan_.max_in_distal_half) return false;
        std::sort(places_m.begin(), places_m.end());
        for (std::size_t k = 1; k < places_m.size(); ++k)
            if (places_m[k] - places_m[k - 1] < spacing_m() - same_place_m) return false;
        return true;
    }

  private:
    double spacing_m() const {
        return std::max(plan_.minimum_spacing * segment_m_ * (plan_.minimum_spacing > 1),
                        plan_.minimum_spacing_m);
    }
    bool is_near(double place_m, const std::vector<double>& places_m) const {
        return std::any_of(places_m.begin(), places_m.end(),
                           [&](double other_m) { return std::abs(other_m - place_m) <= same_place_m; });
    }
    std::vector<double> places_of(const std::vector<int>& nodes) const {
        std::vector<double> places_m;
        for (const int node : nodes) places_m.push_back(node * segment_m_);
        return places_m;
    }
    bool is_forbidden(const SensorOffer& offer) const {
        if (offer.kind != SensorKind::tension) return false;
        if (is_near(offer.place_m, places_of(plan_.forbidden_nodes))) return true;
        const std::vector<double>& ranges = plan_.forbidden_m;
        for (std::size_t k = 0; k + 1 < ranges.size(); k += 2)
            if (offer.place_m >= ranges[k] - same_place_m && offer.place_m <= ranges[k + 1] + same_place_m)
                return true;
        return false;
    }
    bool has_all_required(const std::vector<int>& sensors) const {
        std::vector<double> places_m;
        for (const int sensor : sensors) {
            const SensorOffer& offer = offers_[static_cast<std::size_t>(sensor)];
            if (measures_tension(offer.kind)) places_m.push_back(offer.place_m);
        }
        const auto there = [&](double place_m) { return is_near(place_m, places_m); };
        const std::vector<double> nodes_m = places_of(plan_.required_nodes);
        return std::all_of(nodes_m.begin(), nodes_m.end(), there) &&
               std::all_of(plan_.required_m.begin(), plan_.required_m.end(), there);
    }

    const PlacementPlan& plan_;
    const std::vector<SensorOffer>& offers_;
    double length_m_ = 0.0;
    double segment_m_ = 0.0;
};

// Sensors by kind: where a family may put tension sensors, and what else can be bought.
struct Shelf {
    std::vector<int> along;  // tension sensors, by place
    std::vector<int> others;
};

Shelf shelf_of(const std::vector<SensorOffer>& offers) {
    Shelf shelf;
    for (std::size_t k = 0; k < offers.size(); ++k)
        (offers[k].kind == SensorKind::tension ? shelf.along : shelf.others).push_back(static_cast<int>(k));
    std::stable_sort(shelf.along.begin(), shelf.along.end(),
                     [&](int a, int b) { return offers[a].place_m < offers[b].place_m; });
    return shelf;
}

// Evenly spread from end to end; one sensor in the middle.
std::vector<std::vector<int>> evenly_spread(int count, int places) {
    std::vector<int> chosen;
    for (int k = 0; k < count; ++k) {
        const double at = count == 1 ? 0.5 * (places - 1) : k * (places - 1.0) / (count - 1);
        chosen.push_back(static_cast<int>(std::lround(at)));
    }
    return {chosen};
}

std::vector<std::vector<int>> family_sets(const std::string& family, int count, int places) {
    if (family == "even") return evenly_spread(count, places);
    std::vector<std::vector<int>> sets;
    const LayoutFamily* found = find_layout_family(family);
    if (found == nullptr) return sets;
    for (const Layout& layout : found->layouts(count, places)) sets.push_back(layout.nodes);
    return sets;
}

// Sets by their sensors, each with all its names.
using NamedSets = std::map<std::vector<int>, std::vector<std::string>>;

void add(NamedSets& sets, std::vector<int> sensors, const std::string& name) {
    std::sort(sensors.begin(), sensors.end());
    auto& names = sets[sensors];
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

NamedSets named_sets(const StudyPlan& plan, const std::vector<SensorOffer>& offers) {
    const Shelf shelf = shelf_of(offers);
    const int places = static_cast<int>(shelf.along.size());
    NamedSets along;
    for (const std::string& family : plan.layout_families) {
        for (const int count : plan.sensor_counts) {
            if (count > places) continue;
            for (const std::vector<int>& set : family_sets(family, count, places)) {
                std::vector<int> sensors;
                for (const int place : set) sensors.push_back(shelf.along[static_cast<std::size_t>(place)]);
                add(along, sensors, family);
            }
        }
    }
    for (const std::vector<int>& nodes : plan.explicit_layouts) {
        std::vector<int> sensors;
        for (const int node : nodes)
            if (node < places) sensors.push_back(shelf.along[static_cast<std::size_t>(node)]);
        add(along, sensors, "explicit");
    }
    add(along, {}, "");
    // With each set along the cable every selection of the other sensors.
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

void add_all_sets(NamedSets& sets, const Constraints& constraints, std::vector<int>& sensors, int from,
                  int offers) {
    for (int next = from; next < offers; ++next) {
        sensors.push_back(next);
        if (constraints.may_grow(sensors)) {
            if (constraints.allow(sensors)) add(sets, sensors, "");
            if (sets.size() > max_candidates)
                throw InvalidInput(std::vector<KeyProblem>{
                    {"placement.max_sensors",
                     fmt::format("more than {} sets of sensors are allowed; lower it, offer fewer places "
                                 "in [[sensor]], or set placement.search = \"named\"",
                                 max_candidates)}});
            add_all_sets(sets, constraints, sensors, next + 1, offers);
        }
        sensors.pop_back();
    }
}

}  // namespace

std::vector<Candidate> candidates_of(const StudyPlan& plan, const std::vector<SensorOffer>& offers) {
    const Constraints constraints(plan, offers);
    NamedSets sets = named_sets(plan, offers);
    std::erase_if(sets, [&](const auto& set) { return set.first.empty() || !constraints.allow(set.first); });
    if (plan.placement.search == ComparedSets::all) {
        std::vector<int> sensors;
        add_all_sets(sets, constraints, sensors, 0, static_cast<int>(offers.size()));
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
    return candidates;
}

std::string words_of(const Candidate& candidate, const std::vector<SensorOffer>& offers) {
    if (candidate.sensors.empty()) return "no sensor";
    std::vector<std::string> along;
    std::vector<std::string> parts;
    for (const int sensor : candidate.sensors) {
        const SensorOffer& offer = offers[static_cast<std::size_t>(sensor)];
        if (offer.kind == SensorKind::tension) {
            along.push_back(fmt::format("{:.3g}", offer.place_m));
        } else {
            parts.push_back(words_of(offer));
        }
    }
    if (!along.empty()) {
        const std::string last = along.back();
        along.pop_back();
        parts.insert(parts.begin(),
                     along.empty() ? fmt::format("tension at {} m", last)
                                   : fmt::format("tension at {} and {} m", fmt::join(along, ", "), last));
    }
    return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace capstan
