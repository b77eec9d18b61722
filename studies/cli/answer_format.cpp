#include "capstan/cli/answer_format.h"

#include <filesystem>

namespace capstan::cli {

std::string answer_format(const Invocation& invocation, const std::string& otherwise) {
    if (invocation.has("json")) return "json";
    if (invocation.has("format")) return invocation.text("format");
    const std::string ending = std::filesystem::path(invocation.text("output")).extension().string();
    for (const char* known : {"md", "csv", "json"}) {
        if (ending == std::string(".") + known) return known;
    }
    return otherwise;
}

}  // namespace capstan::cli
