#pragma once

#include "capstan/service/answers.h"

namespace capstan::cli {

/// What the commands answer, for the service.
service::Answers service_answers();

}  // namespace capstan::cli
