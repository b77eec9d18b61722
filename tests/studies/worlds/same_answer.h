#pragma once
// Whether two answers of a study over worlds have the same bits.

#include <gtest/gtest.h>

#include <cstddef>

#include "capstan/worlds/world_study.h"

namespace capstan::testing {

inline bool same(const Expected& a, const Expected& b) {
    return a.candidate == b.candidate && a.objective.value_N == b.objective.value_N &&
           a.error_95_N == b.error_95_N;
}

inline void expect_the_same_answer(const WorldAnswer& a, const WorldAnswer& b) {
    EXPECT_EQ(a.recommended, b.recommended);
    EXPECT_TRUE(same(a.no_sensor, b.no_sensor));
    ASSERT_EQ(a.prices.size(), b.prices.size());
    for (std::size_t k = 0; k < a.prices.size(); ++k) {
        EXPECT_TRUE(same(a.prices[k].expected, b.prices[k].expected)) << k;
        EXPECT_EQ(a.prices[k].alike, b.prices[k].alike);
        EXPECT_EQ(a.prices[k].ties, b.prices[k].ties);
    }
    EXPECT_EQ(a.further_gain.value_N, b.further_gain.value_N);
    EXPECT_EQ(a.grid.order, b.grid.order);
    EXPECT_EQ(a.grid.finest_N, b.grid.finest_N);
}

}  // namespace capstan::testing
