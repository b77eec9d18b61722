#pragma once

#include <optional>
#include <string>

#include "capstan/http/request.h"
#include "capstan/http/server.h"

namespace capstan::http {

struct HeadProblem {
    int status = 400;
    std::string message;
};

/// Why no service may take a request with this head, whoever sends it: too many fields, a field twice that
/// must be there once, a body that is encoded, chunked or too long.
std::optional<HeadProblem> problem_of(const Request& head, const ServerLimits& limits);

bool accepts_gzip(const Request& head);

}  // namespace capstan::http
