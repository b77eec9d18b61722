#include "capstan/placement/stored_study.h"

#include <algorithm>

#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"
#include "capstan/storage/study_store.h"

namespace capstan {

namespace {

std::vector<storage::CableSegmentRecord> cable_segments(const Cable& cable) {
    std::vector<storage::CableSegmentRecord> records;
    for (int i = 0; i < cable.segments(); ++i) {
        const double wrap_rad = cable.wrap_angle_rad()[i];
        storage::CableSegmentRecord record{
            i + 1, cable.node_position_m(i), cable.segment_length_m(i), {}, wrap_rad};
        if (wrap_rad > 0.0) record.bend_radius_m = cable.segment_length_m(i) / wrap_rad;
        records.push_back(record);
    }
    return records;
}

storage::ScenarioRecord scenario_record(const PreparedStudy& study, const PreparedScenario& scenario) {
    const Cable& cable = study.step.cable();
    storage::ScenarioRecord record;
    record.regime = name_of(scenario.regime);
    record.sample = scenario.sample;
    record.time_s = scenario.sample / study.plan.motion.sample_rate_Hz;
    record.proximal_displacement_m = scenario.truth.displacement_m.front();
    record.proximal_increment_m =
        scenario.truth.displacement_m.front() - scenario.previous.displacement_m.front();
    record.motion = record.proximal_increment_m < 0.0 ? "backward" : "forward";
    for (int node = 0; node < cable.nodes(); ++node) {
        record.nodes.push_back({node + 1, cable.node_position_m(node), scenario.truth.tension_N[node],
                                scenario.truth.displacement_m[node], scenario.previous.tension_N[node],
                                scenario.previous.displacement_m[node],
                                sign(node_direction(scenario.truth.last_motion, node, cable.segments()))});
    }
    return record;
}

std::vector<int> from_one(std::vector<int> nodes) {
    for (int& node : nodes) ++node;
    return nodes;
}

void normalise(storage::StudyDescription& description) {
    description.study.study_id = 0;
    description.study.status = "running";
    std::sort(description.regimes.begin(), description.regimes.end(),
              [](const auto& a, const auto& b) { return a.regime < b.regime; });
}

std::string its(const std::string& what, const std::string& one, const std::string& other) {
    return "its " + what + " is " + one + ", not " + other;
}

}  // namespace

storage::StudyDescription describe(const PreparedStudy& study, const std::string& program_version) {
    const StudyPlan& plan = study.plan;
    storage::StudyDescription description;
    description.study.name = plan.name;
    description.study.config_toml = config::config_text(plan, config::Comments::none);
    description.study.program_version = program_version;
    description.study.seed = plan.seed;
    description.study.repetitions = plan.repetitions;
    description.study.segments = study.step.cable().segments();
    description.cable_segments = cable_segments(study.step.cable());
    for (const RegimeInstants& regime : plan.regimes) {
        description.regimes.push_back({std::string(name_of(regime.regime)), regime.duty_fraction});
    }
    for (const PreparedScenario& scenario : study.scenarios) {
        description.scenarios.push_back(scenario_record(study, scenario));
    }
    for (const NamedNoise& noise : plan.noise_levels) {
        description.noise_levels.push_back({noise.label, noise.level.multiplicative_ratio,
                                            noise.level.additive_N, noise.level.bias_N,
                                            noise.level.quantisation_N, noise.level.range_N});
    }
    for (const FusionMethod* method : study.methods) {
        description.fusion_methods.push_back({std::string(method->name), std::string(method->title),
                                              std::string(name_of(method->knowledge)),
                                              std::string(method->meaning)});
    }
    for (const std::vector<int>& nodes : study.sensor_sets)
        description.sensor_sets.push_back({from_one(nodes)});
    for (const PlannedLayout& planned : study.layouts) {
        const Layout& layout = planned.layout;
        description.layouts.push_back({layout.family, layout.start, static_cast<int>(layout.nodes.size()),
                                       layout.label, planned.set_index});
    }
    const int scenarios = static_cast<int>(study.scenarios.size());
    for (int noise = 0; noise < static_cast<int>(plan.noise_levels.size()); ++noise) {
        for (int s = 0; s < scenarios; ++s) description.work_units.push_back({"single_sensor", s, noise});
        for (int s = 0; s < scenarios; ++s) description.work_units.push_back({"fusion", s, noise});
    }
    return description;
}

StoredStudy load_stored_study(storage::Database& database, std::int64_t study_id) {
    storage::StudyDescription description = storage::load_study(database, study_id);
    const std::string where =
        database.path().string() + ", stored configuration of study " + std::to_string(study_id);
    StudyPlan plan = config::parse_config(description.study.config_toml, where).plan;
    return {std::move(description), std::move(plan)};
}

std::string difference_between(storage::StudyDescription one, storage::StudyDescription other) {
    normalise(one);
    normalise(other);
    if (one == other) return {};
    const storage::StudyRecord& a = one.study;
    const storage::StudyRecord& b = other.study;
    if (a.name != b.name) return its("name", "'" + a.name + "'", "'" + b.name + "'");
    if (a.program_version != b.program_version) {
        return its("program", "capstan " + a.program_version, "capstan " + b.program_version);
    }
    if (a.seed != b.seed) return its("seed", std::to_string(a.seed), std::to_string(b.seed));
    if (a.repetitions != b.repetitions) {
        return its("number of repetitions", std::to_string(a.repetitions), std::to_string(b.repetitions));
    }
    if (a.config_toml != b.config_toml) return "its configuration is another one";
    return "the same configuration gave another true motion, as another kind of machine may";
}

}  // namespace capstan
