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
#define CAPSTAN_LIST(method) method,
    static const std::vector<FusionMethod> methods = {CAPSTAN_FUSION_METHODS(CAPSTAN_LIST)};
#undef CAPSTAN_LIST
    return methods;
}

const FusionMethod* find_fusion_method(std::string_view name) {
    for (const FusionMethod& method : fusion_methods()) {
        if (method.name == name) return &method;
    }
    return nullptr;
}

}  // namespace capstan
