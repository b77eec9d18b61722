// Simulates studies in shards and the queue of the service on a machine that fails, one schedule for each
// seed:
//
//     simulate_system CAPSTAN SHIM [--from SEED] [--count N] [--until-failure]
//
// CAPSTAN is the program, SHIM the library sqlite_faults. Every tenth seed is of the queue. The same seed
// gives the same schedule.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "simulated_system.h"

int main(int count_of_words, char** words) {
    using namespace capstan::faults;
    namespace fs = std::filesystem;
    unsigned long long from = 1, count = 1000;
    bool until_failure = false;
    if (count_of_words < 3) return 2;
    for (int k = 3; k < count_of_words; ++k) {
        if (std::strcmp(words[k], "--until-failure") == 0)
            until_failure = true;
        else if (k + 1 < count_of_words && std::strcmp(words[k], "--from") == 0)
            from = std::strtoull(words[++k], nullptr, 10);
        else if (k + 1 < count_of_words && std::strcmp(words[k], "--count") == 0)
            count = std::strtoull(words[++k], nullptr, 10);
        else
            return 2;
    }
    // What is written need not reach a disk.
    const fs::path base = ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : fs::temp_directory_path();
    const fs::path folder = base / ("capstan-system-" + std::to_string(::getpid()));
    fs::create_directories(folder);
    const Reference reference = capstan::faults::reference(folder);
    long processes = 0, faults = 0, failed = 0, done = 0;
    for (unsigned long long seed = from; seed < from + count; ++seed, ++done) {
        const SystemRun run = seed % 10 == 0 ? simulate_queue(seed, reference, words[1], words[2], folder)
                                             : simulate_study(seed, reference, folder);
        processes += run.processes;
        faults += run.faults;
        if (run.problem.empty()) continue;
        ++failed;
        std::printf("seed %llu (%s): %s\n", seed, run.kind.c_str(), run.problem.c_str());
        std::fflush(stdout);
        if (until_failure) break;
    }
    fs::remove_all(folder);
    std::printf("%ld schedules, %ld processes, %ld faults: %ld failed\n", done, processes, faults, failed);
    return failed == 0 ? 0 : 1;
}
