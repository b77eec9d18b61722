// The step and the pull-pull pair on random benches with random inputs, good and bad (walk.h). Same seed,
// same walks. `fuzz_step --steps 10000000` does all of them; the normal test run does a part.
#include <unistd.h>

#include <charconv>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <random>
#include <string_view>
#include <vector>

#include "walk.h"

namespace {

using namespace capstan::fuzz;

struct Options {
    long steps = 200'000;
    long seed = 1;
    long walk = -1;  // this one alone, every input written out; -1: all
};

constexpr std::size_t bytes_per_walk = 4096;
constexpr unsigned longest_walk_s = 120;

std::vector<std::uint8_t> bytes_of(long seed, long walk) {
    std::seed_seq address{seed, walk};
    std::mt19937_64 random(address);
    std::vector<std::uint8_t> bytes(bytes_per_walk);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    return bytes;
}

// For a crash or a walk that does not end: no exception tells where.
char replay[128];
std::size_t replay_length = 0;

void note_replay(const Options& options, long number) {
    replay_length = static_cast<std::size_t>(std::snprintf(
        replay, sizeof replay, "\nreplay: fuzz_step --seed %ld --walk %ld\n", options.seed, number));
}

extern "C" void tell_and_die(int signal) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, replay, replay_length);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

bool try_walk(const Options& options, long number, Tally& tally, std::ostream* trace) {
    note_replay(options, number);
    alarm(longest_walk_s);
    try {
        walk(Choices(bytes_of(options.seed, number)), tally, trace);
        return true;
    } catch (const std::exception& broken) {
        std::cerr << "broken promise: " << broken.what() << replay;
        return false;
    }
}

bool read(int count, char** words, Options& options) {
    for (int k = 1; k + 1 < count; k += 2) {
        const std::string_view name = words[k];
        long* const target = name == "--steps"  ? &options.steps
                             : name == "--seed" ? &options.seed
                             : name == "--walk" ? &options.walk
                                                : nullptr;
        const std::string_view text = words[k + 1];
        if (!target || std::from_chars(text.data(), text.data() + text.size(), *target).ec != std::errc{}) {
            return false;
        }
    }
    return count % 2 == 1;
}

}  // namespace

int main(int count, char** words) {
    Options options;
    if (!read(count, words, options)) {
        std::cerr << "usage: fuzz_step [--steps N] [--seed S] [--walk W]\n";
        return 2;
    }
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGALRM}) std::signal(signal, tell_and_die);
    Tally tally;
    if (options.walk >= 0) {
        std::cout.precision(17);
        return try_walk(options, options.walk, tally, &std::cout) ? 0 : 1;
    }
    int failures = 0;
    constexpr int max_failures = 10;
    for (long number = 0; tally.steps + tally.pull_pull_steps < options.steps && failures < max_failures;
         ++number) {
        failures += !try_walk(options, number, tally, nullptr);
    }
    std::cout << tally << failures << " broken promises\n";
    return failures == 0 ? 0 : 1;
}
