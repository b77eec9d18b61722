// The samples of a recording, beside a sidecar that is in order.
#include "recording_trial.h"
#include "target.h"
#include "temporary_folder.h"

namespace {

constexpr const char* sidecar = R"({
  "mode": "pull_pull", "sample_rate_hz": 20,
  "units": {"t": "s", "motor_torque": "N m", "motor_angle": "rad", "load_angle": "rad", "load_torque": "N m",
            "tension_1": "N"},
  "nominal": {"L": 1.0, "R_profile": [{"s0": 0, "s1": 0.4}, {"s0": 0.4, "s1": 1.0, "R": 0.2}], "K": 4000,
              "mu_d": 0.1, "mu_s": 0.12, "r_input": 0.02, "r_load": 0.1},
  "tension_sensors": [{"channel": "tension_1", "cable": "A", "s": 0.5}],
  "runs": [{"run": 1, "T0": 20, "output": "locked", "driven": ["motor_torque"]},
           {"run": 2, "T0": 20, "output": "handle", "driven": ["load_angle", "motor_angle"]}]
})";

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace capstan::fuzz;
    static const TemporaryFolder folder;
    folder.write("fuzzed.json", sidecar);
    try_recording(folder.write("fuzzed.csv", text_of(data, size)));
    return 0;
}
