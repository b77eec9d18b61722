#include "capstan/placement/placement_answer.h"

#include <algorithm>

namespace capstan {

int count_where_gain_flattens(const std::vector<CountAnswer>& counts, double worthwhile_gain_N) {
    for (const CountAnswer& here : counts) {
        const bool flat = std::all_of(counts.begin(), counts.end(), [&](const CountAnswer& more) {
            const double gain_N = here.optimum.fresh.value_N - more.optimum.fresh.value_N;
            return more.sensors <= here.sensors ||
                   gain_N <= worthwhile_gain_N * (more.sensors - here.sensors);
        });
        if (flat) return here.sensors;
    }
    return counts.empty() ? 0 : counts.back().sensors;
}

}  // namespace capstan
