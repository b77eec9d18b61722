#include <nlohmann/json.hpp>

#include "capstan/cable/invalid_input.h"
#include "capstan/residual_law/residual_law.h"

namespace capstan::residual_law {

namespace {

using nlohmann::json;

json feature_json(const Feature& feature) {
    return {{"kind", name_of(feature.kind)},
            {"parameter", feature.parameter},
            {"times_load", feature.times_load}};
}

Feature feature_from(const json& text) {
    return {feature_kind_of(text.at("kind")), text.at("parameter"), text.at("times_load")};
}

json if_any(const std::optional<double>& value) {
    return value ? json(*value) : json();
}

std::optional<double> number_if_any(const json& value) {
    return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

}  // namespace

std::string law_json(const ResidualLaw& law) {
    json text = {{"scales",
                  {{"motion_middle", law.scales.motion_middle},
                   {"motion_half_range", law.scales.motion_half_range},
                   {"speed", law.scales.speed},
                   {"load", law.scales.load},
                   {"session_s", law.scales.session_s}}},
                 {"weights", json::array()},
                 {"terms", json::array()},
                 {"has_history_model", law.has_history_model},
                 {"residual_rms", law.residual_rms},
                 {"left_out_rms", law.left_out_rms},
                 {"removed_fraction", law.removed_fraction},
                 {"removed_low", if_any(law.removed_low)},
                 {"removed_high", if_any(law.removed_high)},
                 {"band", law.band}};
    for (const WeightedFeature& each : law.weights) {
        json weight = feature_json(each.feature);
        weight["weight"] = each.weight;
        text["weights"].push_back(weight);
    }
    for (const LawTerm& term : law.terms) {
        json features = json::array();
        for (const Feature& feature : term.features) features.push_back(feature_json(feature));
        text["terms"].push_back({{"features", features},
                                 {"size", term.size},
                                 {"half_width", term.half_width},
                                 {"words", term.words}});
    }
    return text.dump();
}

ResidualLaw law_from_json(const std::string& written) {
    try {
        const json text = json::parse(written);
        ResidualLaw law;
        const json& scales = text.at("scales");
        law.scales = {scales.at("motion_middle"), scales.at("motion_half_range"), scales.at("speed"),
                      scales.at("load"), scales.at("session_s")};
        for (const json& each : text.at("weights"))
            law.weights.push_back({feature_from(each), each.at("weight")});
        for (const json& each : text.at("terms")) {
            LawTerm term{{}, each.at("size"), each.at("half_width"), each.at("words")};
            for (const json& feature : each.at("features")) term.features.push_back(feature_from(feature));
            law.terms.push_back(std::move(term));
        }
        law.has_history_model = text.at("has_history_model");
        law.residual_rms = text.at("residual_rms");
        law.left_out_rms = text.at("left_out_rms");
        law.removed_fraction = text.at("removed_fraction");
        law.removed_low = number_if_any(text.at("removed_low"));
        law.removed_high = number_if_any(text.at("removed_high"));
        law.band = text.at("band");
        return law;
    } catch (const json::exception& error) {
        throw InvalidInput({std::string("this is not a law of residuals: ") + error.what()});
    }
}

}  // namespace capstan::residual_law
