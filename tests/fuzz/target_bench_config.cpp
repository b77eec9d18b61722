// A bench's configuration: refused with problems, or a plan whose text gives the same plan again, and whose
// first samples can be simulated.
#include <algorithm>

#include "capstan/bench/bench_run.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"
#include "target.h"

namespace {

using namespace capstan;

constexpr int max_samples = 20;
constexpr int max_segments = 30;

void simulate_a_little(bench::BenchPlan plan) {
    if (plan.cable.segments > max_segments) return;
    plan.duration_s = std::min(plan.duration_s, max_samples / plan.sample_rate_Hz);
    try {
        bench::simulate_bench(plan, [](const bench::BenchInstant&) {});
    } catch (const InvalidInput&) {
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const config::ReadBench config =
            config::parse_plan<bench::BenchPlan>(fuzz::text_of(data, size), "fuzzed.toml");
        const std::string text = config::config_text(config.plan, config::Comments::none);
        const std::string again = config::config_text(
            config::parse_plan<bench::BenchPlan>(text, "again").plan, config::Comments::none);
        fuzz::demand(text == again, "a plan's text gives the same plan:\n" + text + "\n" + again);
        simulate_a_little(config.plan);
    } catch (const config::ConfigError& refusal) {
        fuzz::demand(!refusal.problems().empty(), "a refusal names a problem");
        fuzz::demand(std::string(refusal.what()).starts_with("fuzzed.toml"), refusal.what());
    }
    return 0;
}
