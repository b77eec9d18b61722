#include "capstan/placement/same_study.h"

#include <algorithm>

namespace capstan {

namespace {

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
