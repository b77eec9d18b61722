// Finds why a recorded bench disagrees with its model: diagnose_a_recording LOG.csv. It needs no database.
#include <capstan/model_comparison/diagnosed_runs.h>
#include <capstan/recording/recording_reader.h>

#include <cstdio>

int main(int, char** arguments) {
    const capstan::Recording recording = capstan::read_recording(arguments[1]);
    const auto found = capstan::model_comparison::diagnose_runs(recording, {}, {});
    const capstan::gap::Diagnosis& diagnosis = found.split.diagnosis;
    std::printf("most probable: %s (%.2f)\n", diagnosis.ranked.front().effect.c_str(),
                diagnosis.ranked.front().probability);
    for (const capstan::gap::FittedCause& cause : diagnosis.causes) {
        for (const capstan::gap::FittedNumber& number : cause.numbers)
            std::printf("%s: %s = %.4g %s\n", cause.effect.c_str(), number.name.c_str(), number.value,
                        number.unit.c_str());
    }
    for (const capstan::gap::ChannelGap& channel : diagnosis.gap.channels)
        std::printf("%s: %.2f of the gap is closed\n", channel.channel.c_str(), channel.closed);
    return 0;
}
