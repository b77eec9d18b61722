// Simulates schedules of workers, one for each seed, and names those that lose or double a unit:
//
//     simulate_schedules [--from SEED] [--count N] [--until-failure]

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "simulation.h"

int main(int count_of_words, char** words) {
    unsigned long long from = 1, count = 100'000;
    bool until_failure = false;
    for (int k = 1; k < count_of_words; ++k) {
        if (std::strcmp(words[k], "--until-failure") == 0) {
            until_failure = true;
            continue;
        }
        if (k + 1 == count_of_words) return 2;
        if (std::strcmp(words[k], "--from") == 0)
            from = std::strtoull(words[++k], nullptr, 10);
        else if (std::strcmp(words[k], "--count") == 0)
            count = std::strtoull(words[++k], nullptr, 10);
        else
            return 2;
    }
    long steps = 0, faults = 0, failed = 0;
    for (unsigned long long seed = from; seed < from + count; ++seed) {
        const capstan::units::Schedule schedule = capstan::units::simulate(seed);
        steps += schedule.steps;
        faults += schedule.faults;
        if (schedule.problem.empty()) continue;
        ++failed;
        std::printf("seed %llu (%s): %s\n", seed, schedule.kind.c_str(), schedule.problem.c_str());
        if (until_failure) break;
    }
    std::printf("%llu schedules, %ld operations, %ld faults: %ld failed\n", count, steps, faults, failed);
    return failed == 0 ? 0 : 1;
}
