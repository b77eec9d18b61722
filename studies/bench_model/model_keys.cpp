#include "capstan/bench_model/model_keys.h"

#include <algorithm>

#include "capstan/config/config_effect_keys.h"
#include "capstan/effects/sensor_faults.h"

namespace capstan::bench_model {

std::string key_with_unit(const std::string& name, const std::string& unit) {
    return unit.empty() ? name : name + "_" + config::in_key_letters(unit);
}

std::string effect_key(const EffectNumbers& group) {
    return config::in_key_letters(group.variant.empty() ? group.name : group.name + " " + group.variant);
}

const std::vector<FaultKey>& fault_keys() {
    static const std::vector<FaultKey> all = [] {
        constexpr std::string_view prefix = "sensor_";
        using TypicalOf = SensorFault::TypicalOf;
        std::vector<FaultKey> keys;
        for (const SensorFault& fault : sensor_fault_catalogue()) {
            std::string name = fault.name.starts_with(prefix) ? fault.name.substr(prefix.size()) : fault.name;
            if (!fault.variant.empty()) name = fault.number;
            const std::string unit = fault.typical_of == TypicalOf::time_step ? "s" : fault.unit;
            keys.push_back({name, unit, fault.typical_of == TypicalOf::channel_span,
                            fault.size == SensorFault::Size::either_sign, fault.value, fault.name});
        }
        for (const SensorFault& fault : sensor_fault_catalogue())
            if (fault.shape.value != nullptr)
                keys.push_back({fault.shape.name, "", false, false, fault.shape.value, fault.name});
        return keys;
    }();
    return all;
}

std::string effect_of_fault(const std::string& name) {
    const std::vector<FaultKey>& keys = fault_keys();
    const auto key =
        std::find_if(keys.begin(), keys.end(), [&](const FaultKey& each) { return each.name == name; });
    return key == keys.end() ? "" : key->effect;
}

}  // namespace capstan::bench_model
