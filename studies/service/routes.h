#pragma once

#include <httplib.h>

#include <map>
#include <memory>
#include <mutex>

#include "capstan/service/layout_scorer.h"
#include "capstan/service/report_shelf.h"
#include "capstan/service/service.h"

namespace capstan::service {

/// What the routes share. Each request opens the database for itself, for reading only.
struct RouteContext {
    const ServiceOptions& options;
    JobQueue& queue;
    ReportShelf reports;
    ReportShelf query_answers{};
    std::mutex scorers_mutex{};
    std::map<std::int64_t, std::shared_ptr<LayoutScorer>> scorers{};  // by study

    /// A text about a study, made when the study has gone on since; of one that is complete never an older
    /// one.
    std::shared_ptr<const std::string> about_study(const std::string& what, storage::Database& database,
                                                   std::int64_t study_id, const ReportShelf::Maker& make);

    storage::Database open() const { return storage::Database::open_read_only(options.commands.database); }
};

// One file each; openapi.json describes them all.
void add_page_routes(httplib::Server& server, RouteContext& context);
void add_study_routes(httplib::Server& server, RouteContext& context);
void add_layout_routes(httplib::Server& server, RouteContext& context);
void add_job_routes(httplib::Server& server, RouteContext& context);
void add_diagnosis_routes(httplib::Server& server, RouteContext& context);
void add_query_routes(httplib::Server& server, RouteContext& context);

}  // namespace capstan::service
