#include <algorithm>
#include <limits>

#include "capstan/worlds/choice.h"
#include "capstan/worlds/set_constraints.h"

namespace capstan {

namespace {

// What the next sensor is chosen by.
enum class Merit { error, error_per_price };

// Further sensors in turn that gain less than the resolution; one alone can tell nothing without the next.
constexpr int patience = 2;

std::vector<int> with(std::vector<int> sensors, int sensor) {
    sensors.insert(std::upper_bound(sensors.begin(), sensors.end(), sensor), sensor);
    return sensors;
}

std::vector<int> without(std::vector<int> sensors, int sensor) {
    std::erase(sensors, sensor);
    return sensors;
}

class GreedySearch {
  public:
    explicit GreedySearch(Choice& choice)
        : choice_(choice),
          offers_(choice.table().offers()),
          constraints_(choice.table().plan(), offers_),
          usable_(constraints_.usable()) {}

    void grow(Merit merit) {
        int set = choice_.table().candidate_of(constraints_.fewest().value_or(std::vector<int>{}));
        for (int poor = 0; poor < patience;) {
            const std::optional<int> next = best_further(set, merit);
            if (!next) return;
            const Compared moved = best_moved(*next);
            const double gain_N = gain(set, moved.best.front(), moved.worlds);
            poor = gain_N < choice_.resolution_N() ? poor + 1 : 0;
            set = moved.best.front();
        }
    }

    bool prices_differ() const {
        return std::any_of(usable_.begin(), usable_.end(),
                           [&](int sensor) { return price(sensor) != price(usable_.front()); });
    }

  private:
    double price(int sensor) const { return offers_[static_cast<std::size_t>(sensor)].price; }
    const std::vector<int>& sensors_of(int set) const { return choice_.candidate(set).sensors; }

    // The best set of each price, the cheapest first, all run on so many worlds.
    struct Compared {
        std::vector<int> best;
        int worlds = 0;
    };

    // What is in the table already must not change a decision, so the number of worlds comes from the race.
    Compared compare(const std::vector<int>& sets) {
        std::vector<Group> groups = groups_of(choice_, sets);
        race(choice_, groups, alpha / static_cast<double>(sets.size()));
        Compared compared;
        for (const Group& group : groups) {
            compared.best.push_back(best_of(choice_, group));
            compared.worlds = std::max(compared.worlds, group.worlds);
        }
        run(compared.best, compared.worlds);
        return compared;
    }

    void run(const std::vector<int>& sets, int worlds) {
        choice_.fill(Condition::as_stated, sets, 0, worlds, "the greedy search");
    }

    double gain(int set, int further, int worlds) {
        run({set, further}, worlds);
        return choice_.score(set, 0, worlds) - choice_.score(further, 0, worlds);
    }

    std::optional<int> best_further(int set, Merit merit) {
        std::vector<int> grown;
        for (const int sensor : usable_) {
            const std::vector<int>& sensors = sensors_of(set);
            if (std::binary_search(sensors.begin(), sensors.end(), sensor)) continue;
            std::vector<int> more = with(sensors, sensor);
            if (constraints_.allow(more)) grown.push_back(choice_.table().candidate_of(more));
        }
        if (grown.empty()) return std::nullopt;
        const Compared compared = compare(grown);
        std::optional<int> next;
        double most = -std::numeric_limits<double>::infinity();
        for (const int each : compared.best) {
            const double added = choice_.candidate(each).price - choice_.candidate(set).price;
            const double value =
                gain(set, each, compared.worlds) / (merit == Merit::error ? 1.0 : std::max(added, 1e-9));
            if (value <= most) continue;
            most = value;
            next = each;
        }
        return next;
    }

    // The set itself, or with one sensor at the next usable place of its kind, cable and price on either
    // side.
    Compared best_moved(int set) {
        std::vector<int> moved = {set};
        const std::vector<int> sensors = sensors_of(set);
        for (const int sensor : sensors) {
            for (const double side : {-1.0, 1.0}) {
                const std::optional<int> place = neighbour(sensors, sensor, side);
                if (!place) continue;
                const std::vector<int> there = with(without(sensors, sensor), *place);
                if (constraints_.allow(there)) moved.push_back(choice_.table().candidate_of(there));
            }
        }
        return compare(moved);
    }

    std::optional<int> neighbour(const std::vector<int>& sensors, int sensor, double side) const {
        const SensorOffer& from = offers_[static_cast<std::size_t>(sensor)];
        std::optional<int> nearest;
        double nearest_m = std::numeric_limits<double>::infinity();
        for (const int other : usable_) {
            const SensorOffer& to = offers_[static_cast<std::size_t>(other)];
            const double away_m = side * (to.place_m - from.place_m);
            if (to.kind != from.kind || to.cable != from.cable || to.price != from.price || away_m <= 0.0 ||
                away_m >= nearest_m || std::binary_search(sensors.begin(), sensors.end(), other))
                continue;
            nearest = other;
            nearest_m = away_m;
        }
        return nearest;
    }

    Choice& choice_;
    const std::vector<SensorOffer>& offers_;
    SetConstraints constraints_;
    std::vector<int> usable_;
};

}  // namespace

void search_greedily(Choice& choice) {
    GreedySearch search(choice);
    search.grow(Merit::error);
    if (search.prices_differ()) search.grow(Merit::error_per_price);
}

}  // namespace capstan
