// The pages, and the scripts and styles that they load.
#include <fmt/format.h>
#include <openssl/evp.h>

#include "capstan/answers/glossary.h"
#include "capstan/answers/placement_answers.h"
#include "capstan/placement/stored_study.h"
#include "capstan/reports/embedded_files.h"
#include "capstan/reports/page_frame.h"
#include "capstan/reports/study_comparison.h"
#include "capstan/reports/study_report.h"
#include "capstan/service/exchange.h"
#include "capstan/service/job_results.h"
#include "capstan/service/routes.h"
#include "capstan/storage/error.h"

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
    {"player.js", "text/javascript"},
    {"brush.js", "text/javascript"},
    {"figure_data.js", "text/javascript"},
    {"live.js", "text/javascript"},
    {"pins.js", "text/javascript"},
    {"hand.js", "text/javascript"},
    {"service.js", "text/javascript"},
    {"start.js", "text/javascript"},
    {"query.js", "text/javascript"},
    {"import.js", "text/javascript"},
    {"page.css", "text/css"},
    {"service.css", "text/css"},
    {"notices.txt", "text/plain; charset=utf-8"},
};

constexpr const char* html = "text/html; charset=utf-8";

std::string sha256_base64(std::string_view script) {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    ::EVP_Digest(script.data(), script.size(), digest, &size, EVP_sha256(), nullptr);
    unsigned char base64[2 * EVP_MAX_MD_SIZE];
    const int length = ::EVP_EncodeBlock(base64, digest, static_cast<int>(size));
    return {reinterpret_cast<const char*>(base64), static_cast<std::size_t>(length)};
}

// Of CSP 2.
std::string hash_source(std::string_view script) {
    return " 'sha256-" + sha256_base64(script) + "'";
}

std::string policy_with(const std::string& scripts) {
    return "default-src 'none'; script-src 'self' 'unsafe-eval'" + scripts +
           "; style-src 'self' 'unsafe-inline'; connect-src 'self'; img-src 'self' data: blob:; form-action "
           "'self'; base-uri 'none'; frame-ancestors 'none'";
}

// A page that holds its scripts in itself.
void send_whole_page(http::Response& response, std::shared_ptr<const http::KeptText> page) {
    response.add_header(policy_header, self_contained_page_policy());
    send_kept(response, std::move(page), html);
}

// As its job wrote it, with curves.
std::string diagnosis_page(RouteContext& context, std::int64_t id) {
    if (std::string page = context.queue.answer_of(id, page_file); !page.empty()) return page;
    return reports::answer_html(stored_answer_of(context, id));
}

// A complete study over worlds has an answer of its own.
std::string study_page(storage::Database& database, std::int64_t id) {
    const StudyPlan plan = load_stored_study(database, id).plan;
    if (!plan.uncertainty.is_stated || !study_state(database, id).is_complete)
        return reports::study_live_html(database, id);
    return reports::answer_live_html(answers::stored_world_answer(database, id, plan));
}

std::string comparison_page(RouteContext& context, std::int64_t first, std::int64_t second) {
    storage::Database database = context.open();
    for (const std::int64_t id : {first, second}) {
        study_state(database, id);
        if (load_stored_study(database, id).plan.uncertainty.is_stated)
            throw BadRequest(
                fmt::format("study {} is over worlds; only studies at instants can be compared", id));
    }
    try {
        return reports::answer_html(reports::study_comparison({database, first}, {database, second}));
    } catch (const storage::Error& error) {
        throw BadRequest(error.what(), 409);
    }
}

}  // namespace

const std::string& page_policy() {
    static const std::string policy = policy_with("");
    return policy;
}

const std::string& self_contained_page_policy() {
    static const std::string policy = [] {
        std::string hashes;
        for (const char* name : reports::page_scripts) hashes += hash_source(reports::embedded_file(name));
        return policy_with(hashes);
    }();
    return policy;
}

void add_page_routes(http::Server& server, RouteContext& context) {
    const auto front = http::KeptText::of_program(reports::embedded_file("service.html"));
    server.add("GET", "/",
               [front](const http::Request&, http::Response& response) { send_kept(response, front, html); });
    const auto words = std::make_shared<http::KeptText>(reports::answer_html(answers::glossary_answer()));
    server.add("GET", "/glossary",
               [words](const http::Request&, http::Response& response) { send_whole_page(response, words); });
    for (const WebFile& file : web_files) {
        const auto text = http::KeptText::of_program(reports::embedded_file(file.name));
        server.add("GET", std::string("/web/") + file.name,
                   [&file, text, tag = "W/\"" + sha256_base64(text->plain()) + "\""](
                       const http::Request& request, http::Response& response) {
                       // Another program at the same address has other pages, which need its scripts.
                       response.add_header("Cache-Control", "no-cache");
                       response.add_header("ETag", tag);
                       if (request.header("if-none-match").find(tag) != std::string_view::npos) {
                           response.status = 304;
                           return;
                       }
                       send_kept(response, text, file.content_type);
                   });
    }
    const auto study = [&context](const http::Request& request, http::Response& response) {
        storage::Database database = context.open();
        const std::int64_t id = number_in_path(request);
        send_kept(response,
                  context.about_study("page", database, id, [&] { return study_page(database, id); }), html);
    };
    const auto reports_lane = static_cast<std::size_t>(Lane::reports);
    server.add("GET", "/studies/{study_id}", study, reports_lane);
    const auto diagnosis = [&context](const http::Request& request, http::Response& response) {
        const std::int64_t id = number_in_path(request);
        send_whole_page(response, context.reports.get(fmt::format("diagnosis {}", id), "stored",
                                                      ReportShelf::Freshness::exact,
                                                      [&] { return diagnosis_page(context, id); }));
    };
    server.add("GET", "/diagnoses/{diagnosis_id}", diagnosis, reports_lane);
    const auto answer = [&context](const http::Request& request, http::Response& response) {
        send_whole_page(response,
                        std::make_shared<http::KeptText>(context.answer_of_job(request, page_file)));
    };
    server.add("GET", "/jobs/{job}", answer, reports_lane);
    const auto compare = [&context](const http::Request& request, http::Response& response) {
        const std::int64_t first = number_in_path(request), second = number_in_path(request, 1);
        send_whole_page(response, std::make_shared<http::KeptText>(comparison_page(context, first, second)));
    };
    server.add("GET", "/studies/{study_id}/compare/{other_id}", compare, reports_lane);
}

}  // namespace capstan::service
