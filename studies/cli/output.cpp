#include "capstan/cli/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "capstan/cli/command.h"

namespace capstan::cli {

namespace {

using reports::AnswerFormat;

struct NamedFormat {
    std::string_view name;
    AnswerFormat format;
};
constexpr NamedFormat formats[] = {{"text", AnswerFormat::text},
                                   {"md", AnswerFormat::markdown},
                                   {"csv", AnswerFormat::csv},
                                   {"json", AnswerFormat::json},
                                   {"html", AnswerFormat::html}};

std::optional<AnswerFormat> format_named(std::string_view name) {
    for (const NamedFormat& each : formats) {
        if (each.name == name) return each.format;
    }
    return std::nullopt;
}

}  // namespace

ShownWork::ShownWork(const Invocation& invocation, std::string activity)
    : activity_(std::move(activity)),
      display_(progress_mode(invocation.text("progress")), std::chrono::seconds(1)),
      meter_([this](double fraction) { show(fraction); }),
      scope_(&meter_) {
    show(0.0);
}

ShownWork::~ShownWork() = default;

void ShownWork::show(double fraction) {
    ProgressEvent event;
    event.activity = activity_;
    event.fraction = fraction;
    display_.show(std::move(event));
}

void ShownWork::end() {
    show(1.0);
    display_.end_line();
}

void deliver(const Invocation& invocation, std::string_view text) {
    const std::string& file = invocation.text("output");
    if (file == "-") return write_standard_output(text);
    write_file(file, text);
}

void deliver_page(const Invocation& invocation, const reports::Answer& answer) {
    if (!invocation.has("html")) return;
    const std::string& file = invocation.text("html");
    write_file(file, reports::answer_html(answer));
    say(fmt::format("Wrote {}.", file));
}

AnswerFormat answer_format(const Invocation& invocation, AnswerFormat otherwise) {
    if (invocation.has("json")) return AnswerFormat::json;
    if (invocation.has("format")) return format_named(invocation.text("format")).value_or(otherwise);
    const std::string ending = std::filesystem::path(invocation.text("output")).extension().string();
    if (ending.empty()) return otherwise;
    const std::string name = ending == ".txt" ? "text" : ending == ".htm" ? "html" : ending.substr(1);
    if (const auto named = format_named(name)) return *named;
    // A text may be kept under any other name; a page or a picture is nothing else.
    constexpr std::string_view refused[] = {".pdf", ".svg", ".png", ".jpg", ".tex", ".docx", ".xlsx"};
    if (otherwise == AnswerFormat::html || std::ranges::find(refused, ending) != std::end(refused))
        throw UsageError(fmt::format(
            "capstan {}: -o {}: it writes text, md, csv, json and html, no {}. `capstan report -o FILE.pdf` "
            "prints a study's page, and `capstan report --figures FOLDER` writes SVG and PNG",
            invocation.command().name, invocation.text("output"), ending));
    return otherwise;
}

void deliver_answer(const Invocation& invocation, const reports::Answer& answer) {
    deliver_page(invocation, answer);
    const AnswerFormat format = answer_format(invocation, AnswerFormat::text);
    const std::string text = reports::answer_in(answer, format);
    deliver(invocation, format == AnswerFormat::text ? printable(text) : text);
}

}  // namespace capstan::cli
