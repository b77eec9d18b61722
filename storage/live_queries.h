#pragma once
// What someone who watches a database asks again and again: small SELECTs, named.

#include <cstdint>
#include <string_view>

#include "capstan/storage/read_only_query.h"

namespace capstan::storage {

// The studies, with how far each has come; no parameter.
extern const std::string_view studies_query;

// The diagnoses, newest first; no parameter.
extern const std::string_view diagnoses_query;

// The work units of a study (?1) with regime, instant and noise level, done or not.
extern const std::string_view units_query;

// The cable of a study (?1), segment by segment.
extern const std::string_view cable_query;

}  // namespace capstan::storage
