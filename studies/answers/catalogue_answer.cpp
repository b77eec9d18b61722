#include <algorithm>

#include "capstan/answers/study_answers.h"
#include "capstan/config/config_effect_keys.h"
#include "capstan/effects/effect_catalogue.h"
#include "capstan/effects/known_causes.h"
#include "capstan/estimation/fusion_method.h"
#include "capstan/sensing/layout.h"

namespace capstan::answers {

namespace {

using reports::Column;
using reports::Data;

Data parameter_data(const EffectParameter& parameter, double absent) {
    return {{"key", config::effect_key_name(parameter)},
            {"unit", parameter.unit},
            {"low", parameter.low},
            {"high", parameter.high},
            {"typical", parameter.typical},
            {"is_size", parameter.role == ParameterRole::size},
            {"absent", absent}};
}

Data effects_data() {
    Data effects = Data::list();
    for (const Effect& effect : effect_catalogue()) {
        Data parameters = Data::list();
        for (std::size_t p = 0; p < effect.parameters.size(); ++p)
            parameters.push_back(parameter_data(effect.parameters[p], effect.absent[p]));
        effects.push_back({{"name", effect.name},
                           {"variant", effect.variant},
                           {"title", effect.title},
                           {"section", config::effect_section("effect", effect)},
                           {"family", effect.family},
                           {"component", effect.component},
                           {"equation", effect.equation},
                           {"meaning", effect.meaning},
                           {"needs_pair", effect.needs_pair},
                           {"changes_the_cable", effect.changes_the_cable},
                           {"confusable_with", confusable_causes(effect.name)},
                           {"parameters", parameters}});
    }
    return effects;
}

Data other_causes_data() {
    Data causes = Data::list();
    for (const KnownCause& cause : known_causes()) {
        const auto& effects = effect_catalogue();
        if (std::any_of(effects.begin(), effects.end(),
                        [&](const Effect& e) { return e.name == cause.name; }))
            continue;
        causes.push_back({{"name", cause.name},
                          {"title", cause.title},
                          {"family", cause.family},
                          {"confusable_with", confusable_causes(cause.name)}});
    }
    return causes;
}

Data layouts_data() {
    Data families = Data::list();
    for (const LayoutFamily& family : layout_families())
        families.push_back({{"name", family.name}, {"title", family.title}, {"meaning", family.meaning}});
    return families;
}

Data methods_data() {
    Data methods = Data::list();
    for (const FusionMethod& method : fusion_methods())
        methods.push_back({{"name", method.name},
                           {"title", method.title},
                           {"knowledge", name_of(method.knowledge)},
                           {"meaning", method.meaning},
                           {"source", method.source}});
    return methods;
}

std::vector<Column> catalogue_columns(std::initializer_list<const char*> names) {
    std::vector<Column> columns;
    for (const char* name : names) columns.push_back({.path = name, .title = name});
    return columns;
}

}  // namespace

reports::Answer catalogue_answer() {
    reports::Answer answer{.id = "catalogue", .kind = "What the program knows", .title = "catalogue"};
    answer.values = {{"effects", effects_data()},
                     {"other_causes", other_causes_data()},
                     {"layouts", layouts_data()},
                     {"fusion_methods", methods_data()}};
    answer.headline =
        "Effects that a bench can have, causes besides them that a diagnosis can name, layouts and fusion methods.";
    answer.sections = {
        {.id = "effects",
         .heading = "Effects",
         .tables = {{"effects", "", catalogue_columns({"title", "variant", "section", "equation", "meaning"}),
                     answer.values["effects"]}}},
        {.id = "other_causes",
         .heading = "Other causes",
         .tables = {{"other_causes", "", catalogue_columns({"title", "name", "family"}),
                     answer.values["other_causes"]}}},
        {.id = "layouts",
         .heading = "Layouts",
         .tables = {{"layouts", "", catalogue_columns({"title", "name", "meaning"}),
                     answer.values["layouts"]}}},
        {.id = "fusion_methods",
         .heading = "Fusion methods",
         .tables = {{"fusion_methods", "",
                     catalogue_columns({"title", "name", "knowledge", "meaning", "source"}),
                     answer.values["fusion_methods"]}}}};
    return answer;
}

}  // namespace capstan::answers
