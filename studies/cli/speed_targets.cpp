#include "capstan/cli/speed_targets.h"

#include <fmt/format.h>

#include <iterator>

namespace capstan::cli {

std::string in_words(const std::vector<SpeedTarget>& targets) {
    std::string text = fmt::format("{:52}  {:>10}  {:>16}\n", "target", "measured", "shall be");
    auto out = std::back_inserter(text);
    for (const SpeedTarget& target : targets) {
        const std::string limit =
            fmt::format("{} {:.3g}", target.at_least ? "at least" : "at most", target.target);
        const std::string verdict =
            target.met() ? "met" : fmt::format("short by {:.0f}%", 100.0 * target.short_by());
        fmt::format_to(out, "{:52}  {:>10.3g}  {:>16}  {}\n", target.what + " [" + target.unit + "]",
                       target.measured, limit, verdict);
    }
    return text;
}

}  // namespace capstan::cli
