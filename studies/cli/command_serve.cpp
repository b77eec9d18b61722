#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <future>

#include "capstan/cable/invalid_input.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/watched_run.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/service/service.h"
#include "capstan/storage/database.h"

namespace capstan::cli {

namespace {

std::string random_token() {
    std::ifstream random("/dev/urandom", std::ios::binary);
    unsigned char bytes[16] = {};
    if (!random.read(reinterpret_cast<char*>(bytes), sizeof bytes))
        throw std::runtime_error("cannot read random numbers for a token; give a --token-file");
    std::string token;
    for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
    return token;
}

std::string token_in(const std::string& file) {
    std::ifstream stream(file);
    std::string token;
    if (!std::getline(stream, token) || token.size() < 16)
        throw UsageError(fmt::format(
            "capstan serve: {} must hold a token of at least 16 characters in its first line", file));
    if (token.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-_.") !=
        std::string::npos)
        throw UsageError(
            fmt::format("capstan serve: the token in {} may have letters, digits, - _ and . only", file));
    return token;
}

service::ServiceOptions service_options_of(const Invocation& invocation) {
    service::ServiceOptions options;
    options.access.host = invocation.text("host");
    options.access.port = invocation.count("port");
    if (invocation.has("token-file")) {
        options.access.token = token_in(invocation.text("token-file"));
    } else if (!service::is_loopback(options.access.host)) {
        options.access.token = random_token();
    }
    options.commands = {std::filesystem::read_symlink("/proc/self/exe").string(),
                        std::filesystem::absolute(invocation.text("db")).string(), invocation.count("jobs")};
    if (invocation.has("configs")) {
        options.configs = invocation.text("configs");
        if (!std::filesystem::is_directory(*options.configs))
            throw UsageError(
                fmt::format("capstan serve: --configs {} is not a folder", options.configs->string()));
    }
    options.query_limit_s = invocation.number("query-limit");
    return options;
}

ExitCode run_serve(const Invocation& invocation) {
    { storage::Database::open_or_create(invocation.text("db")); }  // creates or checks the file
    const service::ServiceOptions options = service_options_of(invocation);
    service::Service service(options);
    const bool anywhere = options.access.host == "0.0.0.0" || options.access.host == "::";
    const std::string host = anywhere ? "127.0.0.1" : options.access.host;
    const std::string token = options.access.token.empty() ? "" : "?token=" + options.access.token;
    const StopRequest stoppable;
    say(fmt::format(
        "capstan serves {} at http://{}:{}/{}\nCtrl-C stops it; a running study continues at the next start.",
        invocation.text("db"), host, service.port(), token));

    std::future<void> running = std::async(std::launch::async, [&] { service.run(); });
    // This thread receives the signals and waits for nothing else.
    while (running.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
        if (StopRequest::flag()->load()) service.stop();
    }
    running.get();
    return ExitCode::success;
}

}  // namespace

Command serve_command() {
    return {
        .name = "serve",
        .summary = "Serve a database to a browser: studies, reports, diagnoses, SQL.",
        .description =
            "Starts a small web service for a workstation or a lab. Its pages run studies one after the "
            "other and show their progress, plot their reports with filters, score layouts that a user "
            "draws on the cable, diagnose uploaded recordings, and run SQL queries; /openapi.json "
            "describes the same functions for programs. Jobs are stored beside the database (FILE.jobs) "
            "and survive a restart or a kill: the tables end with the same bits. The service listens on "
            "this machine only unless --host is given; then every request needs a token.",
        .options =
            {database_option,
             {.name = "port",
              .letter = 'p',
              .kind = OptionKind::integer,
              .value = "N",
              .meaning = "Port to listen on; 0 takes a free port.",
              .default_value = "8321",
              .limits = {0, 65535}},
             {.name = "host",
              .value = "ADDRESS",
              .meaning =
                  "Address to listen on. Any address other than this machine's own requires a token, which is "
                  "printed.",
              .default_value = "127.0.0.1"},
             {.name = "token-file",
              .value = "FILE",
              .meaning =
                  "Require the token in the first line of FILE with every request; it has at least 16 letters "
                  "and digits."},
             {.name = "configs",
              .value = "FOLDER",
              .meaning = "Folder of configurations that users can start by name."},
             {.name = "query-limit",
              .kind = OptionKind::number,
              .value = "SECONDS",
              .meaning = "Stop a query after this time.",
              .default_value = "5",
              .limits = {0.01, 600}},
             jobs_option,
             help_option},
        .examples = {"capstan serve --configs configs", "capstan serve --port 0",
                     "capstan serve --host 0.0.0.0 --token-file token.txt"},
        .run = run_serve,
        .time = "Until it is stopped."};
}

}  // namespace capstan::cli
