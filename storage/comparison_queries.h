#pragma once
// What a comparison of two studies (?1, ?2) reads: what they have in common, by name.

#include <string_view>

namespace capstan::storage {

// Errors of both where regime, noise label, layout family, count and method are the same. Intervals of
// differences take the two studies' draws for independent.
extern const std::string_view compared_errors_query;

// The best that needs no known direction, by count: one row a study, regime, noise label and count.
extern const std::string_view compared_best_query;

// What each recommends, by scope, regime and noise label.
extern const std::string_view compared_recommendations_query;

}  // namespace capstan::storage
