// Untrusted bytes to the HTTP server alone: whatever comes, the answer is one answer of HTTP, the handlers
// see only what is well-formed, and the server goes on. The first byte says whether the rest is a complete
// request, a form, or a path.
#include <thread>

#include "answer_to.h"
#include "capstan/http/multipart.h"
#include "capstan/http/server.h"
#include "capstan/http/target.h"
#include "target.h"

namespace {

using namespace capstan;

http::Response text(int status, const std::string& words) {
    http::Response response;
    response.status = status;
    response.content_type = "text/plain";
    response.text = std::make_shared<http::KeptText>(words);
    return response;
}

// Its handlers repeat what they were given; one of them fails.
class Echo {
  public:
    Echo() : server_(options()), port_(listen()), thread_([this] { server_.run(); }) {}
    ~Echo() {
        server_.stop();
        thread_.join();
    }

    int port() const { return port_; }

  private:
    static http::ServerOptions options() {
        return {.gate = [](const http::Request&) { return http::Verdict{}; },
                .problem = text,
                .failure = [](const std::exception_ptr&) { return text(500, "failed"); },
                .limits = {.body_bytes = 1 << 16}};
    }

    int listen() {
        const auto repeat = [](const http::Request& request, http::Response& response) {
            fuzz::demand(request.path.find('\0') == std::string::npos, "no path has a zero byte");
            fuzz::demand(request.body.size() == request.content_length.value_or(0), "a body is complete");
            fuzz::demand(request.headers.size() <= 100, "no head has more fields than allowed");
            response = text(200, request.path + "\n" + request.body);
            response.is_kept = true;
        };
        server_.add("GET", "/", repeat);
        server_.add("GET", "/{name}/{number}", repeat);
        server_.add("POST", "/post", repeat);
        return server_.listen("127.0.0.1", 0);
    }

    http::Server server_;
    int port_;
    std::thread thread_;
};

void check_form(const std::string& body) {
    const auto parts = http::parse_form("multipart/form-data; boundary=part", body);
    if (!parts) return;
    fuzz::demand(parts->size() <= http::max_form_parts, "the number of parts is limited");
    for (const http::FormPart& part : *parts) {
        fuzz::demand(!part.name.empty(), "a part has a name");
        fuzz::demand(part.content.data() >= body.data() &&
                         part.content.data() + part.content.size() <= body.data() + body.size(),
                     "a part is in the body");
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Echo echo;
    if (size == 0) return 0;
    const std::string input = fuzz::text_of(data + 1, size - 1);
    if (data[0] == 'f') {
        check_form(input);
    } else if (data[0] == 't') {
        if (const auto target = http::parse_target(input))
            fuzz::demand(target->path.starts_with('/'), "a path begins with a slash");
    } else {
        const std::string answer = fuzz::answer_to(input, echo.port());
        fuzz::demand(answer.empty() || answer.starts_with("HTTP/1.1 "), "an answer is HTTP");
        fuzz::demand(!answer.starts_with("HTTP/1.1 500"), "no failure of our own");
    }
    return 0;
}
