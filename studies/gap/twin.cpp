#include "capstan/gap/twin.h"

#include "capstan/cable/invalid_input.h"
#include "capstan/gap/known_bench.h"
#include "capstan/gap/lumped_drive.h"

namespace capstan::gap {

std::vector<double> nominal_values(const Twin& twin) {
    std::vector<double> values;
    for (const TwinParameter& parameter : twin.parameters()) values.push_back(parameter.nominal);
    return values;
}

std::unique_ptr<Twin> make_twin(const Recording& recording, int segments) {
    switch (recording.mode) {
        case BenchMode::pull_pull:
            return make_pull_pull_twin(recording, segments);
        case BenchMode::single_cable:
            return make_single_cable_twin(recording, segments);
        case BenchMode::lumped_drive:
            return make_lumped_drive_twin(recording);
        case BenchMode::capstan_band:
            break;
    }
    throw InvalidInput({recording.name +
                        ": there is no model of a band round a drum yet; known are pull_pull, "
                        "single_cable and lumped_drive"});
}

}  // namespace capstan::gap
