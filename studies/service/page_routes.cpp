// The pages, and the scripts and styles that they load.
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
};

}  // namespace

void add_page_routes(httplib::Server& server, RouteContext& context) {
    server.Get("/", [&context](const httplib::Request& request, httplib::Response& response) {
        // The address that `capstan serve` prints carries the token once; later requests carry it in a
        // cookie.
        if (request.has_param("token")) {
            if (!same_secret(request.get_param_value("token"), context.options.access.token))
                throw BadRequest("The token is wrong.", 401);
            response.set_header("Set-Cookie", "capstan_token=" + context.options.access.token +
                                                  "; HttpOnly; SameSite=Strict; Path=/");
            response.set_redirect("/", 303);
            return;
        }
        send_text(response, std::string(reports::embedded_file("service.html")), "text/html; charset=utf-8");
    });
    for (const WebFile& file : web_files) {
        server.Get(std::string("/web/") + file.name,
                   [&file](const httplib::Request&, httplib::Response& response) {
                       const std::string_view text = reports::embedded_file(file.name);
                       response.set_header("Cache-Control", "max-age=3600");
                       response.set_content(text.data(), text.size(), file.content_type);
                   });
    }
    server.Get(R"(/studies/(\d+))", [&context](const httplib::Request& request, httplib::Response& response) {
        storage::Database database = context.open();
        const std::int64_t id = number_in_path(request);
        const auto page =
            context.about_study("page", database, id, [&] { return reports::study_live_html(database, id); });
        response.set_content(*page, "text/html; charset=utf-8");
    });
}

}  // namespace capstan::service
