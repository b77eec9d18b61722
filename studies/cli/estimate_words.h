#pragma once

#include <string>
#include <vector>

#include "capstan/estimate/left_out.h"
#include "capstan/recording/recording.h"

namespace capstan::cli {

struct LeftOutCable {
    const estimate::SensedCable* cable = nullptr;
    std::vector<estimate::LeftOutChannel> channels;
};

std::string left_out_words(const Recording& recording, const std::vector<LeftOutCable>& results);
std::string left_out_json(const Recording& recording, const std::vector<LeftOutCable>& results);

/// How an estimate was made, without its samples, which are CSV.
std::string whole_json(const Recording& recording, const std::vector<estimate::SensedCable>& cables,
                       const std::vector<estimate::WholeEstimate>& wholes);

}  // namespace capstan::cli
