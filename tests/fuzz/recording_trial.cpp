#include "recording_trial.h"

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/twin.h"
#include "capstan/recording/recording_reader.h"
#include "target.h"

namespace capstan::fuzz {

namespace {

constexpr int segments = 8;
constexpr int max_samples = 200;  // longer runs only take longer

}  // namespace

void try_recording(const std::filesystem::path& samples) {
    try {
        const Recording recording = read_recording(samples);
        const auto twin = gap::make_twin(recording, segments);
        if (recording.runs.front().samples() > max_samples) return;
        const gap::TwinRun run = twin->run(0, gap::nominal_values(*twin));
        demand(run.values.size() == recording.channels.size(), "a twin has the recording's channels");
    } catch (const InvalidInput& refusal) {
        demand(!refusal.problems().empty(), "a refusal names a problem");
    }
}

}  // namespace capstan::fuzz
