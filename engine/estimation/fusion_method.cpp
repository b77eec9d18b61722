#include "capstan/estimation/fusion_method.h"

namespace capstan {

std::string_view name_of(Knowledge knowledge) {
    switch (knowledge) {
        case Knowledge::direction_known:
            return "direction_known";
        case Knowledge::direction_unknown:
            return "direction_unknown";
        case Knowledge::feasible_curve:
            return "feasible_curve";
    }
    return {};
}

const std::vector<FusionMethod>& fusion_methods() {
    static const std::vector<FusionMethod> methods = {
        mean_known_direction,   mean_method,
        mean_r_method,          weighted_mean_method,
        weighted_mean_r_method, maximum_likelihood_method,
        posterior_mean_method,
    };
    return methods;
}

const FusionMethod* find_fusion_method(std::string_view name) {
    for (const FusionMethod& method : fusion_methods()) {
        if (method.name == name) return &method;
    }
    return nullptr;
}

}  // namespace capstan
