// The pages, and the scripts and styles that they load.
#include "capstan/answers/glossary.h"
#include "capstan/reports/embedded_files.h"
#include "capstan/reports/study_report.h"
#include "capstan/service/exchange.h"
#include "capstan/service/routes.h"

namespace capstan::service {

namespace {

struct WebFile {
    const char* name;
    const char* content_type;
};

constexpr WebFile web_files[] = {
    {"vega.min.js", "text/javascript"},
    {"vega-lite.min.js", "text/javascript"},
    {"vega-embed.min.js", "text/javascript"},
    {"page.js", "text/javascript"},
    {"live.js", "text/javascript"},
    {"service.js", "text/javascript"},
    {"import.js", "text/javascript"},
    {"page.css", "text/css"},
    {"service.css", "text/css"},
    {"notices.txt", "text/plain; charset=utf-8"},
};

constexpr const char* html = "text/html; charset=utf-8";

}  // namespace

void add_page_routes(http::Server& server, RouteContext& context) {
    const auto front = http::KeptText::of_program(reports::embedded_file("service.html"));
    server.add("GET", "/",
               [front](const http::Request&, http::Response& response) { send_kept(response, front, html); });
    const auto words = std::make_shared<http::KeptText>(reports::answer_html(answers::glossary_answer()));
    server.add("GET", "/glossary",
               [words](const http::Request&, http::Response& response) { send_kept(response, words, html); });
    for (const WebFile& file : web_files) {
        const auto text = http::KeptText::of_program(reports::embedded_file(file.name));
        server.add("GET", std::string("/web/") + file.name,
                   [&file, text](const http::Request&, http::Response& response) {
                       response.add_header("Cache-Control", "max-age=3600");
                       send_kept(response, text, file.content_type);
                   });
    }
    const auto study = [&context](const http::Request& request, http::Response& response) {
        storage::Database database = context.open();
        const std::int64_t id = number_in_path(request);
        send_kept(
            response,
            context.about_study("page", database, id, [&] { return reports::study_live_html(database, id); }),
            html);
    };
    server.add("GET", "/studies/{study_id}", study, static_cast<std::size_t>(Lane::reports));
}

}  // namespace capstan::service
