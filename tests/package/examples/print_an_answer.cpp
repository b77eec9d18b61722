// Prints what `capstan duty LOG` prints: how often a recorded drive was in each motion regime.
#include <capstan/answers/recording_answers.h>
#include <capstan/recording/recording_reader.h>

#include <cstdio>

int main(int, char** arguments) {
    const capstan::Recording recording = capstan::read_recording(arguments[1]);
    const capstan::duty::DutyCycle duty = capstan::duty::measure_duty(recording, {});
    std::fputs(capstan::reports::answer_text(capstan::answers::duty_answer(recording, duty)).c_str(), stdout);
    return 0;
}
