// The sidecar of a recording, beside samples that have the columns and runs that it speaks of, where it does.
#include <cmath>
#include <nlohmann/json.hpp>

#include "recording_trial.h"
#include "target.h"
#include "temporary_folder.h"

namespace {

using nlohmann::json;

constexpr int samples_per_run = 24;
constexpr std::size_t max_runs = 3;

// Any channel moves, each in its own way.
std::string samples_for(const json& sidecar) {
    const json units = sidecar.is_object() ? sidecar.value("units", json()) : json();
    const json runs = sidecar.is_object() ? sidecar.value("runs", json()) : json();
    const json rate = sidecar.is_object() ? sidecar.value("sample_rate_hz", json()) : json();
    const double rate_Hz = rate.is_number() && rate > 0.0 ? rate.get<double>() : 1.0;
    std::string text = "run,t";
    std::size_t channels = 0;
    if (units.is_object()) {
        for (const auto& unit : units.items()) {
            if (unit.key() == "t") continue;
            text += "," + unit.key();
            ++channels;
        }
    }
    text += "\n";
    for (std::size_t run = 0; runs.is_array() && run < std::min(max_runs, runs.size()); ++run) {
        const json number = runs[run].is_object() ? runs[run].value("run", json(1)) : json(1);
        for (int sample = 0; sample < samples_per_run; ++sample) {
            text += number.dump(-1, ' ', false, json::error_handler_t::replace) + "," +
                    std::to_string(sample / rate_Hz);
            for (std::size_t channel = 0; channel < channels; ++channel)
                text +=
                    "," + std::to_string(0.1 * std::sin(0.3 * sample * (1.0 + static_cast<double>(channel))));
            text += "\n";
        }
    }
    return text;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace capstan::fuzz;
    static const TemporaryFolder folder;
    const std::string text = text_of(data, size);
    folder.write("fuzzed.json", text);
    try_recording(folder.write("fuzzed.csv", samples_for(json::parse(text, nullptr, false))));
    return 0;
}
