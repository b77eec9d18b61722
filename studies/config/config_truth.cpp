#include "capstan/config/config_truth.h"

#include <fmt/format.h>

#include "capstan/config/config_effect_keys.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_study_keys.h"
#include "capstan/config/config_writer.h"

namespace capstan::config {

namespace {

using StudyKey = ConfigKey<StudyPlan>;

StudyKey ratio_key(const std::string& name, const std::string& of, double TrueCable::*ratio) {
    return number(
        {"truth", name, "", "Ratio of the true value to that in [transmission], for " + of + "."},
        {0.01, true, 100.0}, 1.0, [ratio](auto& plan, int) -> auto& { return plan.truth.*ratio; });
}

StudyKey fraction_key(const std::string& name, const std::string& of, double TrueCable::*fraction) {
    StudyKey key = number(
        {"truth", name, "",
         "95 % of the worlds lie within this fraction of " + of +
             "; 0: as [uncertainty] says. `--from-diagnosis` sets it to the fit's interval."},
        {0.0, true, 5.0}, 0.0, [fraction](auto& plan, int) -> auto& { return plan.truth.*fraction; });
    key.condition = with_worlds;
    return key;
}

StudyKey deviations_key(std::size_t e) {
    StudyKey key = number_list<StudyPlan>(
        {effect_section("truth", effect_catalogue()[e]), "deviations", "",
         "Standard deviations over the worlds of the numbers above, in their order "
         "and units; none: all worlds have the numbers above."},
        zero_or_more, {}, [e](auto& plan, int) -> auto& { return plan.truth.effect_deviations[e]; });
    key.allowed.may_be_empty = true;
    key.condition = with_worlds;
    return key;
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
        ratio_key("pretension_ratio", "the pretension", &TrueCable::pretension_ratio),
        fraction_key("friction_fraction", "friction_ratio", &TrueCable::friction_fraction),
        fraction_key("stiffness_fraction", "stiffness_ratio", &TrueCable::stiffness_fraction),
        fraction_key("pretension_fraction", "pretension_ratio", &TrueCable::pretension_fraction)};
    add_effect_keys(
        keys, "truth", std::mem_fn(&Effect::changes_the_cable),
        [](auto& plan) -> auto& { return plan.truth.effects; });
    for (std::size_t e = 0; e < effect_catalogue().size(); ++e)
        if (effect_catalogue()[e].changes_the_cable) keys.push_back(deviations_key(e));
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
