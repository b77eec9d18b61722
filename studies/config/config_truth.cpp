#include "capstan/config/config_truth.h"

#include <fmt/format.h>

#include "capstan/config/config_effect_keys.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"

namespace capstan::config {

namespace {

using StudyKey = ConfigKey<StudyPlan>;

StudyKey ratio_key(const std::string& name, const std::string& of, double TrueCable::*ratio) {
    return number(
        {"truth", name, "", "Ratio of the true value to that in [transmission], for " + of + "."},
        {0.01, true, 100.0}, 1.0, [ratio](auto& plan, int) -> auto& { return plan.truth.*ratio; });
}

}  // namespace

std::vector<ConfigSection<StudyPlan>> truth_sections() {
    std::vector<ConfigSection<StudyPlan>> sections = {
        {"truth",
         "How the true cable differs from the one above, which the estimators assume; by default it "
         "does not. `capstan diagnose --corrected FILE` writes this section from a recording, "
         "`capstan study run --truth FILE` reads it. Effects require prescribed positions at both "
         "ends."}};
    add_effect_sections(sections, "truth", std::mem_fn(&Effect::changes_the_cable));
    return sections;
}

std::vector<StudyKey> truth_keys() {
    std::vector<StudyKey> keys = {
        ratio_key("friction_ratio", "both friction coefficients", &TrueCable::friction_ratio),
        ratio_key("stiffness_ratio", "the axial stiffness", &TrueCable::stiffness_ratio),
        ratio_key("pretension_ratio", "the pretension", &TrueCable::pretension_ratio)};
    add_effect_keys(
        keys, "truth", std::mem_fn(&Effect::changes_the_cable),
        [](auto& plan) -> auto& { return plan.truth.effects; });
    return keys;
}

TrueCable read_truth(const std::filesystem::path& path) {
    const ReadConfig config = read_config(path);
    std::vector<ConfigProblem> problems;
    for (const auto& [key, line] : config.lines) {
        if (!key.empty() && !key.starts_with("truth"))
            problems.push_back({line, 0, key, "does not belong in a --truth file, which holds only [truth]"});
    }
    if (!problems.empty()) throw ConfigError(path.string(), std::move(problems));
    return config.plan.truth;
}

std::string truth_text(const TrueCable& truth, const std::vector<std::string>& comments) {
    std::string text;
    for (const std::string& comment : comments) text += "# " + comment + "\n";
    text += fmt::format("\n[truth]\nfriction_ratio = {}\nstiffness_ratio = {}\npretension_ratio = {}\n",
                        toml_number(truth.friction_ratio), toml_number(truth.stiffness_ratio),
                        toml_number(truth.pretension_ratio));
    for (std::size_t e = 0; e < truth.effects.size(); ++e) {
        const Effect& effect = effect_catalogue()[e];
        if (truth.effects[e] == effect.absent) continue;
        text += fmt::format("\n[{}]  # {}\n", effect_section("truth", effect), effect.meaning);
        for (std::size_t p = 0; p < effect.parameters.size(); ++p)
            text += fmt::format("{} = {}\n", effect_key_name(effect.parameters[p]),
                                toml_number(truth.effects[e][p]));
    }
    return text;
}

}  // namespace capstan::config
