#include "capstan/suggestion/column_motion.h"

#include <algorithm>
#include <cmath>

#include "capstan/platform/statistics.h"

namespace capstan::imports {

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const std::size_t count = std::min(a.size(), b.size());
    if (count < 3) return 0.0;
    const double mean_a = mean_of(a);
    const double mean_b = mean_of(b);
    double ab = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        ab += (a[k] - mean_a) * (b[k] - mean_b);
        aa += (a[k] - mean_a) * (a[k] - mean_a);
        bb += (b[k] - mean_b) * (b[k] - mean_b);
    }
    return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

double loop_work(const std::vector<double>& torque, const std::vector<double>& angle) {
    const std::size_t count = std::min(torque.size(), angle.size());
    const double mean_torque = mean_of(torque);
    double sum = 0.0;
    for (std::size_t k = 1; k < count; ++k)
        sum += (0.5 * (torque[k] + torque[k - 1]) - mean_torque) * (angle[k] - angle[k - 1]);
    return sum;
}

bool looks_like_angle(const SeenColumn& column) {
    double first = 0.0;
    double second = 0.0;
    for (std::size_t k = 2; k < column.readings.size(); ++k) {
        const double change = column.readings[k] - column.readings[k - 1];
        const double bend = column.readings[k] - 2.0 * column.readings[k - 1] + column.readings[k - 2];
        first += change * change;
        second += bend * bend;
    }
    return second < first;
}

ColumnsByMotion columns_by_motion(const std::vector<const SeenColumn*>& columns) {
    constexpr double min_alike = 0.5;
    std::vector<const SeenColumn*> angles;
    std::vector<const SeenColumn*> torques;
    for (const SeenColumn* column : columns) (looks_like_angle(*column) ? angles : torques).push_back(column);
    ColumnsByMotion found{.angles_alike = min_alike};
    for (std::size_t a = 0; a < angles.size(); ++a) {
        for (std::size_t b = a + 1; b < angles.size(); ++b) {
            const double alike = std::abs(correlation(angles[a]->readings, angles[b]->readings));
            if (alike <= found.angles_alike) continue;
            found = {.motor_angle = angles[a], .load_angle = angles[b], .angles_alike = alike};
        }
    }
    if (found.motor_angle == nullptr && !angles.empty()) found.motor_angle = angles.front();
    if (found.motor_angle == nullptr) return found;
    const auto loop = [&](const SeenColumn* torque) {
        return std::abs(loop_work(torque->readings, found.motor_angle->readings)) / torque->span;
    };
    std::stable_sort(torques.begin(), torques.end(), [&](auto* a, auto* b) { return loop(a) > loop(b); });
    if (!torques.empty()) found.motor_torque = torques[0];
    if (torques.size() > 1) found.load_torque = torques[1];
    return found;
}

}  // namespace capstan::imports
