#include "capstan/import/survey.h"

#include <algorithm>
#include <cmath>

#include "capstan/platform/statistics.h"

namespace capstan::imports {

namespace {

// Enough for medians; a log's beginning is like its rest.
constexpr std::size_t sampled_readings = 65536;
constexpr std::size_t kept_jumps = 64;
// A row of equal readings at an extreme is a saturated sensor if it is this long, and so many times longer
// than any row of equal readings elsewhere.
constexpr std::size_t shortest_plateau = 10;
constexpr std::size_t plateau_factor = 4;
constexpr std::size_t never_remarkable = 2;
// Readings lie on a lattice if they do to this part of its step.
constexpr double lattice_tolerance = 0.02;

/// Rows of equal readings, and where they are.
class Plateaus {
  public:
    void add(double time_s, double value) {
        if (length_ > 0 && value == value_) {
            ++length_;
            return;
        }
        close();
        value_ = value;
        from_s_ = time_s;
        length_ = 1;
    }

    void close() {
        if (length_ == 0) return;
        if (length_ > never_remarkable && kept_.size() < sampled_readings)
            kept_.push_back({value_, from_s_, length_});
    }

    void find_saturated(ChannelSurvey& survey) {
        close();
        std::size_t elsewhere = never_remarkable;
        for (const Plateau& plateau : kept_) {
            if (plateau.value != survey.high && plateau.value != survey.low)
                elsewhere = std::max(elsewhere, plateau.length);
        }
        for (const Plateau& plateau : kept_) {
            if (plateau.value != survey.high && plateau.value != survey.low) continue;
            if (plateau.length < std::max(shortest_plateau, plateau_factor * elsewhere)) continue;
            if (survey.saturated == 0) survey.saturated_at_s = plateau.from_s;
            survey.saturated += plateau.length;
        }
    }

  private:
    struct Plateau {
        double value;
        double from_s;
        std::size_t length;
    };
    double value_ = 0.0;
    double from_s_ = 0.0;
    std::size_t length_ = 0;
    std::vector<Plateau> kept_;
};

/// How often the two outermost readings on one side occur. A converter's last step is rare; a limit is not.
class Outermost {
  public:
    explicit Outermost(double side) : side_(side) {}

    void add(double time_s, double value) {
        const double out = side_ * value;
        if (count_ == 0 || out > first_) {
            second_ = first_;
            second_count_ = count_;
            first_ = out;
            count_ = 0;
            from_s_ = time_s;
        } else if (out < first_ && (second_count_ == 0 || out > second_)) {
            second_ = out;
            second_count_ = 0;
        }
        if (out == first_) ++count_;
        if (out == second_ && out != first_) ++second_count_;
    }

    bool is_limit() const { return count_ >= shortest_plateau && count_ > limit_factor * second_count_; }
    std::size_t count() const { return count_; }
    double from_s() const { return from_s_; }

  private:
    static constexpr std::size_t limit_factor = 20;
    double side_;
    double first_ = 0.0;
    double second_ = 0.0;
    std::size_t count_ = 0;
    std::size_t second_count_ = 0;
    double from_s_ = 0.0;
};

struct Jump {
    double change = 0.0;
    double distance_s = 0.0;

    bool operator>(const Jump& other) const { return change > other.change; }
};

void note_jump(std::vector<Jump>& largest, const Jump& jump) {
    if (largest.size() == kept_jumps && !(jump > largest.back())) return;
    largest.insert(std::upper_bound(largest.begin(), largest.end(), jump, std::greater<>()), jump);
    if (largest.size() > kept_jumps) largest.pop_back();
}

// The step that all changes are multiples of; 0 without one.
double lattice_step(const std::vector<double>& changes, double span) {
    double step = 0.0;
    for (const double change : changes) {
        if (change > 1e-9 * span && (step == 0.0 || change < step)) step = change;
    }
    if (step == 0.0) return 0.0;
    // The mean of the changes over their integer numbers of steps is the step without rounding.
    double sum = 0.0;
    double count = 0.0;
    for (const double change : changes) {
        const double steps = std::round(change / step);
        if (steps < 1.0 || steps > 1000.0) continue;
        if (std::abs(change - steps * step) > lattice_tolerance * step * std::max(1.0, 0.02 * steps))
            return 0.0;
        if (steps < 20.0) {
            sum += change;
            count += steps;
        }
    }
    // Fewer than this many levels within the span would be a switch; more than 2^20 is how numbers are
    // printed.
    if (count < 3.0 || span / step > 1048576.0) return 0.0;
    return sum / count;
}

}  // namespace

ChannelSurvey survey_channel(const Source& source, RowRange rows) {
    ChannelSurvey survey;
    Track track(source, rows);
    Plateaus plateaus;
    Outermost highest(1.0);
    Outermost lowest(-1.0);
    std::vector<double> distances;
    std::vector<double> changes;
    double time_s = 0.0;
    double value = 0.0;
    double last_s = 0.0;
    double last = 0.0;
    std::vector<Jump> jumps;
    std::vector<TimeGap> wide;  // not yet known to be gaps
    double period_s = 0.0;
    const auto settle_period = [&] {
        if (!distances.empty()) period_s = median(distances);
        std::erase_if(wide, [&](const TimeGap& gap) { return gap.to_s - gap.from_s <= 1.5 * period_s; });
    };
    while (track.next(time_s, value)) {
        if (survey.readings == 0) {
            survey.first_s = time_s;
            survey.low = survey.high = value;
        } else {
            const double distance_s = time_s - last_s;
            const double change = std::abs(value - last);
            if (distances.size() < sampled_readings) {
                distances.push_back(distance_s);
                changes.push_back(change);
                if (distances.size() == sampled_readings) settle_period();
            }
            // Until the period is known, whatever is wider than the first distances.
            const double usual_s = period_s > 0.0 ? period_s : distances.front();
            if (distance_s > 1.5 * usual_s || (period_s == 0.0 && distance_s > usual_s))
                wide.push_back({last_s, time_s});
            note_jump(jumps, {change, distance_s});
        }
        survey.low = std::min(survey.low, value);
        survey.high = std::max(survey.high, value);
        plateaus.add(time_s, value);
        highest.add(time_s, value);
        lowest.add(time_s, value);
        ++survey.readings;
        last_s = time_s;
        last = value;
    }
    settle_period();
    for (const Jump& jump : jumps) {
        if (jump.distance_s <= 1.5 * period_s) survey.largest_jumps.push_back(jump.change);
    }
    survey.last_s = last_s;
    survey.missing = track.missing;
    survey.repeated = track.repeated;
    survey.backward = track.backward;
    survey.period_s = period_s;
    if (survey.readings == 0) return survey;
    for (const TimeGap& gap : wide) {
        if (gap.to_s - gap.from_s > longest_bridge_periods * period_s) {
            survey.gaps.push_back(gap);
        } else {
            ++survey.bridged;
        }
    }
    std::vector<double> deviations;
    for (const double distance_s : distances) deviations.push_back(std::abs(distance_s - period_s));
    if (period_s > 0.0) survey.jitter = median(deviations) / period_s;
    survey.step = lattice_step(changes, survey.high - survey.low);
    if (!changes.empty()) {
        const auto ninth = changes.begin() + static_cast<std::ptrdiff_t>(changes.size() * 9 / 10);
        std::nth_element(changes.begin(), ninth, changes.end());
        survey.typical_change = *ninth;
    }
    if (!survey.constant()) plateaus.find_saturated(survey);
    for (const Outermost* side : {&highest, &lowest}) {
        if (survey.saturated > 0 || survey.constant() || !side->is_limit()) continue;
        survey.saturated = side->count();
        survey.saturated_at_s = side->from_s();
    }
    return survey;
}

double wrap_range(const ChannelSurvey& survey, const Source& source) {
    const double unit = std::abs(source.factor);
    std::vector<double> ranges;  // in the column's unit
    const auto known = find_unit(source.mapping->unit);
    if (known && known->quantity == Quantity::angle) ranges.push_back(find_unit("turn")->si / known->si);
    if (source.mapping->counts_per_turn) ranges.push_back(*source.mapping->counts_per_turn);
    if (known && known->quantity == Quantity::counts) {
        for (int bits = 8; bits <= 32; ++bits) ranges.push_back(std::exp2(bits));
    }
    const double span = (survey.high - survey.low) / unit;
    const double usual = survey.typical_change / unit;
    for (const double range : ranges) {
        if (span > range * (1.0 + 1e-6) || span < 0.9 * range) continue;
        bool any = false;
        bool all = true;
        for (const double jump_si : survey.largest_jumps) {
            const double jump = jump_si / unit;
            if (jump <= 0.5 * range) break;
            any = true;
            all &= range - jump <= std::max(10.0 * usual, 0.02 * range);
        }
        if (any && all && 20.0 * usual < range) return range;
    }
    return 0.0;
}

}  // namespace capstan::imports
