#include "capstan/reports/page_frame.h"

#include <fmt/format.h>

#include "capstan/reports/embedded_files.h"
#include "capstan/reports/html_text.h"

namespace capstan::reports {
namespace {

constexpr const char* live_scripts[] = {"pins.js", "hand.js", "live.js"};

std::string scripts(PageFiles files) {
    std::string html;
    if (files == PageFiles::served) {
        for (const char* name : page_scripts)
            html += fmt::format("<script src=\"/web/{}\"></script>\n", name);
        for (const char* name : live_scripts)
            html += fmt::format("<script src=\"/web/{}\"></script>\n", name);
        return html;
    }
    for (const char* name : page_scripts) {
        html += fmt::format("<script data-file=\"{}\">{}</script>\n", name, embedded_file(name));
    }
    return html;
}

// The content security policy enforces that the page loads nothing. The service sends its own policy.
std::string style(PageFiles files) {
    if (files == PageFiles::served) {
        return R"(<link rel="icon" href="data:,">
<link rel="stylesheet" href="/web/page.css">
<link rel="stylesheet" href="/web/service.css">
)";
    }
    return fmt::format(
        R"(<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline' 'unsafe-eval'; img-src data: blob:">
<style>
{}</style>
)",
        embedded_file("page.css"));
}

// What the licences of the chart scripts ask of every copy.
std::string notices(PageFiles files) {
    if (files == PageFiles::served)
        return "<p><a href=\"/glossary\">Glossary</a> · <a href=\"/web/notices.txt\">Licences of the figures' scripts</a></p>";
    return fmt::format(
        "<details class=\"notices\"><summary>Licences of the figures' scripts</summary>\n<pre>{}</pre></details>",
        escape_html(embedded_file("notices.txt")));
}

std::string head_html(const PageFrame& frame, PageFiles files) {
    return fmt::format(
        R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{}</title>
{}</head>
)",
        escape_html(frame.document_title), style(files));
}

}  // namespace

std::string program_version() {
    return CAPSTAN_VERSION;
}

std::string page_html(const PageFrame& frame, PageFiles files) {
    std::string page = head_html(frame, files);
    page += fmt::format(
        R"(<body>
<a class="skip" href="#content">Skip to the content</a>
<header>
<p class="kind">{}</p>
<h1>{}</h1>
<p class="verdict">{}</p>
</header>
)",
        escape_html(frame.kind), escape_html(frame.title), escape_html(frame.verdict));
    page += frame.navigation_html;
    page +=
        "<main id=\"content\" tabindex=\"-1\">\n<noscript><p>The figures need JavaScript; the words and "
        "tables do not.</p></noscript>\n";
    page += frame.main_html + "</main>\n";
    page += fmt::format("<footer><p>{}{}</p>{}</footer>\n", escape_html(frame.footer),
                        files == PageFiles::inside ? " This page needs no network." : "", notices(files));
    page += "<script type=\"application/json\" id=\"study-data\">" + frame.data_json + "</script>\n";
    return page + scripts(files) + "</body>\n</html>\n";
}

std::string section_html(const std::string& id, const std::string& title, const std::string& intro,
                         const std::string& content) {
    if (content.empty()) return "";
    return fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n<p "
        "class=\"intro\">{2}</p>\n"
        "{3}</section>\n",
        id, escape_html(title), escape_html(intro), content);
}

std::string navigation_html(const std::string& main_html, const std::vector<SectionLink>& links,
                            const std::string& extra_html) {
    std::string items;
    for (const SectionLink& link : links) {
        if (main_html.find("<section id=\"" + link.id + "\"") == std::string::npos) continue;
        items += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", link.id, escape_html(link.title));
    }
    return "<nav aria-label=\"Sections\"><ul>\n" + items + "</ul>\n" + extra_html + "</nav>\n";
}

}  // namespace capstan::reports
