#pragma once

#include <string>

#include "capstan/placement/prepared_study.h"
#include "capstan/storage/records.h"

namespace capstan {

/// A prepared study as the database keeps it. Work units: for each noise level the single-sensor stage of
/// every scenario, then the fusion stage of every scenario.
storage::StudyDescription describe(const PreparedStudy& study, const std::string& program_version);

}  // namespace capstan
