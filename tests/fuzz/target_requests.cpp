// Requests to the service: bodies of every route that takes one, paths, and complete requests. Every
// answer is HTTP and reports an error of the sender, never one of the service (500).
#include <memory>
#include <thread>

#include "answer_to.h"
#include "capstan/service/service.h"
#include "sample_database.h"
#include "target.h"

namespace {

using namespace capstan;

constexpr int max_jobs = 50;  // then the service starts anew: its list of jobs only grows

// A service on loopback, with a program for its jobs that does nothing.
class Host {
  public:
    explicit Host(const fuzz::TemporaryFolder& folder)
        : jobs_(folder.path() / "sample.db.jobs"),
          service_({{}, {"/bin/true", folder.path() / "sample.db", 1}, {}, 0.5}),
          thread_([this] { service_.run(); }) {}
    ~Host() {
        service_.stop();
        thread_.join();
        std::error_code ignored;
        std::filesystem::remove_all(jobs_, ignored);
    }

    int port() const { return service_.port(); }

  private:
    std::filesystem::path jobs_;
    service::Service service_;
    std::thread thread_;
};

std::string post(const std::string& path, const std::string& type, const std::string& body, int port) {
    return "POST " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
           "\r\nContent-Type: " + type + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" +
           body;
}

// The first byte says what the others are.
std::string request_of(char what, const std::string& rest, int port) {
    const std::string json = "application/json";
    switch (what) {
        case 'q':
            return post("/api/query", json, rest, port);
        case 's':
            return post("/api/studies", json, rest, port);
        case 'l':
            return post("/api/studies/1/layout", json, rest, port);
        case 'd':
            return post("/api/diagnoses", "multipart/form-data; boundary=part", rest, port);
        case 'p':
            return post(rest.substr(0, rest.find_first_of(" \r\n")), json, "{}", port);
        case 'g':
            return "GET " + rest.substr(0, rest.find_first_of(" \r\n")) +
                   " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n\r\n";
        default:
            return rest;
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::TemporaryFolder folder;
    static const auto database = fuzz::make_sample_database(folder);
    static auto host = std::make_unique<Host>(folder);
    static int jobs = 0;
    if (size == 0) return 0;
    const std::string text = fuzz::text_of(data, size);
    const std::string answer =
        fuzz::answer_to(request_of(text[0], text.substr(1), host->port()), host->port());
    const std::string head = answer.substr(0, answer.find('\n'));
    fuzz::demand(answer.empty() || answer.starts_with("HTTP/1.1 "), "an answer is HTTP: " + head);
    fuzz::demand(!answer.starts_with("HTTP/1.1 500"), "no failure of our own: " + answer);
    jobs += answer.starts_with("HTTP/1.1 202");
    if (jobs >= max_jobs) {
        jobs = 0;
        host.reset();
        host = std::make_unique<Host>(folder);
    }
    return 0;
}
