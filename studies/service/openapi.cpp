// The interface as OpenAPI 3, from the rows of the routes.
#include <set>

#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"

namespace capstan::service {

namespace {

using Json = ordered_json;

const std::vector<std::pair<std::string, std::vector<ApiField>>>& components() {
    static const std::vector<std::pair<std::string, std::vector<ApiField>>> list{
        {"Problem", {{"error", "string"}}},
        {"Study",
         {{"study_id", "integer"},
          {"name", "string"},
          {"status", "running|complete"},
          {"units_done", "integer"},
          {"units", "integer"},
          {"begun_utc", "string", "As 2026-01-31T12:00:00Z; empty if that is unknown"},
          {"note", "string"},
          {"tags", "string", "Words with blanks between them"}}},
        {"Job",
         {{"job", "integer", "Its number, from 1"},
          {"kind", "study|diagnosis|place|sensitivity|estimate"},
          {"title", "string"},
          {"state", "queued|running|stopped|done|failed"},
          {"activity", "string", "What is being done"},
          {"fraction", "number", "Of the work that is done"},
          {"seconds_left", "number?"},
          {"max_seconds_left", "number?",
           "Where the time left is known as a range, from seconds_left to this"},
          {"message", "string", "Why it failed"},
          {"study_id", "integer?", "Of a study, once it is stored", false},
          {"diagnosis_id", "integer?", "Of a diagnosis, once it is stored", false}}},
        {"LayoutScore",
         {{"mean_abs_error_N", "number"},
          {"interval_low_N", "number", "Of the 95% interval"},
          {"interval_high_N", "number"},
          {"repetitions", "integer"},
          {"instants", "integer"},
          {"nodes", "[NodeError]"},
          {"reference", "LayoutScore", "Of the layout to compare with", false},
          {"worse_than_reference_N", "number", "On the same draws", false},
          {"worse_interval_N", "[number]", "95%, paired", false}}},
        {"PlacedSensors",
         {{"set", "string", "In words"},
          {"price", "number"},
          {"allowed", "boolean", "By the constraints of the study"},
          {"worlds", "integer"},
          {"expected_error_N", "number"},
          {"monte_carlo_interval_N", "[number]", "95%"},
          {"error_95_N", "number", "That 95% of the worlds stay below"},
          {"gain_over_no_sensor_N", "number"},
          {"gain_interval_N", "[number]", "95%, paired"},
          {"recommended", "string", "The recommended set in words"},
          {"worse_than_recommended_N", "number"},
          {"worse_interval_N", "[number]", "95%, paired"},
          {"distinguishable", "boolean", "From the recommended set, by a paired t test at 5%"}}},
        {"NodeError",
         {{"node", "integer"},
          {"mean_abs_error_N", "number"},
          {"bias_N", "number"},
          {"low_N", "number", "Absolute errors of 90% of the draws are between this"},
          {"high_N", "number", "and this"}}},
    };
    return list;
}

Json type_schema(std::string type) {
    if (type.front() == '[')
        return {{"type", "array"}, {"items", type_schema(type.substr(1, type.size() - 2))}};
    if (type.back() == '?') {
        Json schema = type_schema(type.substr(0, type.size() - 1));
        schema["nullable"] = true;
        return schema;
    }
    if (type == "binary") return {{"type", "string"}, {"format", "binary"}};
    if (std::isupper(static_cast<unsigned char>(type.front())) != 0)
        return {{"$ref", "#/components/schemas/" + type}};
    if (type.find('|') == std::string::npos) return {{"type", type}};
    Json words = Json::array();
    for (std::size_t bar = 0; (bar = type.find('|')) != std::string::npos; type.erase(0, bar + 1))
        words.push_back(type.substr(0, bar));
    words.push_back(type);
    return {{"type", "string"}, {"enum", words}};
}

Json object_schema(const std::vector<ApiField>& fields) {
    Json schema = {{"type", "object"}};
    for (const ApiField& field : fields) {
        Json& property = schema["properties"][field.name] = type_schema(field.type);
        if (!field.meaning.empty()) property["description"] = field.meaning;
        if (field.is_required) schema["required"].push_back(field.name);
    }
    return schema;
}

Json parameters_of(const std::string& path) {
    Json parameters = Json::array();
    for (std::size_t open = 0; (open = path.find('{', open)) != std::string::npos; ++open) {
        const std::string name = path.substr(open + 1, path.find('}', open) - open - 1);
        const Json schema =
            name == "name" ? Json{{"type", "string"}} : Json{{"type", "integer"}, {"minimum", 1}};
        parameters.push_back({{"name", name}, {"in", "path"}, {"required", true}, {"schema", schema}});
    }
    return parameters;
}

Json operation(const Route& route) {
    Json json = {{"operationId", route.operation_id}, {"summary", route.summary}};
    if (route.method == "post")
        json["requestBody"] = {{"required", true},
                               {"content", {{route.body_type, {{"schema", object_schema(route.body)}}}}}};
    Json& success = json["responses"][std::to_string(route.status)];
    success["description"] = route.answer;
    for (const auto& [content_type, type] : route.answer_types)
        success["content"][content_type] = {{"schema", type_schema(type)}};
    std::set<int> failures(route.failures.begin(), route.failures.end());
    if (route.path.find('{') != std::string::npos) failures.insert(404);
    for (const int status : failures)
        json["responses"][std::to_string(status)] = {{"$ref", "#/components/responses/Error"}};
    return json;
}

}  // namespace

std::string openapi_text(const std::vector<Route>& routes) {
    Json json = {
        {"openapi", "3.0.3"},
        {"info",
         {{"title", "capstan serve"},
          {"version", "1"},
          {"description",
           "Studies and diagnoses of one results database. A request with a body needs a Content-Length and, "
           "except for uploads, the content type application/json. If the service requires a token, send the "
           "header 'Authorization: Bearer TOKEN'."}}}};
    for (const Route& route : routes) {
        Json& path = json["paths"][route.path];
        if (Json parameters = parameters_of(route.path); !parameters.empty())
            path["parameters"] = std::move(parameters);
        path[route.method] = operation(route);
    }
    Json& parts = json["components"];
    parts["securitySchemes"]["token"] = {{"type", "http"}, {"scheme", "bearer"}};
    parts["responses"]["Error"] = {{"description", "Why the request was refused"},
                                   {"content", {{"application/json", {{"schema", type_schema("Problem")}}}}}};
    for (const auto& [name, fields] : components()) parts["schemas"][name] = object_schema(fields);
    return json.dump(1) + "\n";
}

std::vector<Route> api_routes(RouteContext& context) {
    std::vector<Route> routes;
    for (const auto& part : {study_routes, study_action_routes, layout_routes, job_routes, answer_routes,
                             diagnosis_routes, import_routes, query_routes})
        for (Route& route : part(context)) routes.push_back(std::move(route));
    routes.push_back(
        {"get", "/openapi.json", "openapi", "This description", "OpenAPI 3", json_of("object"), {}});
    routes.back().handler = [text = openapi_text(routes)](const http::Request&, http::Response& response) {
        send_text(response, text, "application/json");
    };
    return routes;
}

}  // namespace capstan::service
