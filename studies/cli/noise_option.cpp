#include "capstan/cli/noise_option.h"

#include <fmt/format.h>

#include "capstan/cli/usage_error.h"
#include "capstan/platform/nearest_name.h"

namespace capstan::cli {

const Option noise_option{.name = "noise",
                          .kind = OptionKind::string,
                          .value = "LABEL",
                          .meaning = "Noise level of the configuration to use. Default: the first."};

int noise_index_of(const StudyPlan& plan, const Invocation& invocation) {
    if (!invocation.has("noise")) return 0;
    std::vector<std::string> labels;
    for (std::size_t k = 0; k < plan.noise_levels.size(); ++k) {
        labels.push_back(plan.noise_levels[k].label);
        if (labels.back() == invocation.text("noise")) return static_cast<int>(k);
    }
    throw UsageError(fmt::format("--noise: the configuration has no noise level \"{}\"{}",
                                 invocation.text("noise"), suggestion(invocation.text("noise"), labels)));
}

}  // namespace capstan::cli
