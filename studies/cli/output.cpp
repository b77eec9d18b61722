#include "capstan/cli/output.h"

#include <fmt/format.h>

#include "capstan/cli/usage_error.h"

namespace capstan::cli {

void deliver(const Invocation& invocation, std::string_view text) {
    const std::string& file = invocation.text("output");
    if (file == "-") return write_standard_output(text);
    write_file(file, text);
}

void deliver_page(const Invocation& invocation, const std::function<std::string()>& page) {
    if (!invocation.has("html")) return;
    const std::string& file = invocation.text("html");
    if (file == "-") {
        throw UsageError(
            "--html -: standard output is taken by the answer in words or CSV; name a file, as page.html");
    }
    write_file(file, page());
    say(fmt::format("Wrote {}.", file));
}

}  // namespace capstan::cli
