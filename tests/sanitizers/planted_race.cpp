// Tasks of oneTBB that add to one number: `planted_race plant` without a word between them, `leave` each to a
// slot of its own, summed after the join, as all of capstan does.
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstdio>
#include <string_view>
#include <thread>

namespace {

constexpr int tasks = 1000;
constexpr int max_rounds = 1000;

struct Sum {
    long plain = 0;
    tbb::enumerable_thread_specific<long> slots{0L};
};

// Returns whether more than one thread took part.
bool add_up(Sum& sum, bool plant) {
    std::atomic<int> others{0};
    const std::thread::id here = std::this_thread::get_id();
    tbb::parallel_for(0, tasks, [&](int k) {
        if (std::this_thread::get_id() != here) others.fetch_add(1, std::memory_order_relaxed);
        if (plant) {
            sum.plain += k;
        } else {
            sum.slots.local() += k;
        }
    });
    return others > 0;
}

}  // namespace

int main(int count, char** words) {
    const bool plant = count > 1 && std::string_view(words[1]) == "plant";
    Sum sum;
    int rounds = 0;
    bool shared = false;
    while (!shared && rounds < max_rounds) {
        shared = add_up(sum, plant);
        ++rounds;
    }
    for (const long slot : sum.slots) sum.plain += slot;
    std::printf("%ld after %d rounds, %s\n", sum.plain, rounds,
                shared ? "threads shared the work" : "one thread alone");
    return shared ? 0 : 2;
}
