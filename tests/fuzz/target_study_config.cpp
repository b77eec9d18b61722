// A study's configuration: refused with problems, or a plan whose text gives the same plan again, and which
// either cannot run and says so, or can be prepared.
#include "capstan/cable/invalid_input.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"
#include "capstan/placement/prepared_study.h"
#include "target.h"

namespace {

using namespace capstan;

// A long motion of a long cable is valid, but would take the fuzzer's time.
constexpr double max_node_steps = 20'000;
constexpr std::size_t max_studies = 4;
constexpr std::size_t max_instants = 8;

bool soon_done(const StudyPlan& plan) {
    std::size_t instants = 0;
    for (const RegimeInstants& regime : plan.regimes) instants += regime.samples.size();
    const double nodes = plan.transmission.cable.segments + 1.0;
    return nodes <= 65 && nodes * plan.motion.samples <= max_node_steps && instants <= max_instants;
}

std::size_t studies_of(const Sweep& sweep) {
    std::size_t studies = 1;
    for (const auto* list : {&sweep.friction_ratio, &sweep.curvature_ratio, &sweep.stiffness_ratio})
        studies *= std::max<std::size_t>(1, list->size());
    return studies * std::max<std::size_t>(1, sweep.segments.size());
}

void prepare_all(const config::ReadConfig& config) {
    if (!soon_done(config.plan) || studies_of(config.plan.sweep) > max_studies) return;
    for (const int segments : config.plan.sweep.segments) {
        if (segments > 64) return;
    }
    try {
        for (const StudyPlan& study : config::runnable_studies(config)) {
            if (soon_done(study)) prepare(study);
        }
    } catch (const config::ConfigError&) {
    } catch (const InvalidInput&) {
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const config::ReadConfig config = config::parse_config(fuzz::text_of(data, size), "fuzzed.toml");
        const std::string text = config::config_text(config.plan, config::Comments::none);
        const std::string again =
            config::config_text(config::parse_config(text, "again").plan, config::Comments::none);
        fuzz::demand(text == again, "a plan's text gives the same plan:\n" + text + "\n" + again);
        prepare_all(config);
    } catch (const config::ConfigError& refusal) {
        fuzz::demand(!refusal.problems().empty(), "a refusal names a problem");
        fuzz::demand(std::string(refusal.what()).starts_with("fuzzed.toml"), refusal.what());
    }
    return 0;
}
