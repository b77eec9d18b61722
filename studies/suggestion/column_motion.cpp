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

}  // namespace capstan::imports
