#include "capstan/calibration/parameter_file.h"

#include <algorithm>

#include "capstan/recording/json_object.h"

namespace capstan::gap {

std::vector<double> read_parameter_values(const std::filesystem::path& path,
                                          const std::vector<TwinParameter>& parameters) {
    std::vector<double> values;
    for (const TwinParameter& parameter : parameters) values.push_back(parameter.nominal);
    ProblemList problems;
    const nlohmann::json json = read_json_file(path);
    for (const JsonObject& each : JsonObject(json, path.string() + ": ", problems).objects("parameters")) {
        const std::string name = each.text("name");
        const auto found =
            std::find_if(parameters.begin(), parameters.end(),
                         [&](const TwinParameter& parameter) { return parameter.name == name; });
        if (found == parameters.end()) {
            each.add_problem("name", "is '" + name + "', which this recording's bench does not have");
        } else {
            values[static_cast<std::size_t>(found - parameters.begin())] = each.positive("value");
        }
    }
    problems.throw_if_any();
    return values;
}

}  // namespace capstan::gap
