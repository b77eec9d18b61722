#pragma once

#include <string>

namespace capstan::service {

/// What the service answers, as OpenAPI 3 (JSON).
const std::string& openapi_text();

}  // namespace capstan::service
