#include "capstan/config/config_effect_keys.h"

namespace capstan::config {

std::string in_key_letters(std::string text) {
    const auto replace = [&](const std::string& what, const std::string& by) {
        for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
            text.replace(at, what.size(), by);
    };
    replace("N m", "Nm");
    replace("(", "");
    replace(")", "");
    replace("1/", "per_");
    replace("/", "_per_");
    replace(" ", "_");
    return text;
}

std::string effect_section(const std::string& root, const Effect& effect) {
    return root + "." +
           in_key_letters(effect.variant.empty() ? effect.name : effect.name + " " + effect.variant);
}

std::string effect_key_name(const EffectParameter& parameter) {
    return parameter.name + (parameter.unit.empty() ? "" : "_" + in_key_letters(parameter.unit));
}

}  // namespace capstan::config
