// A browser without a window prints the page, or draws its figures and leaves them in it: see
// leaveFigureFiles() in reports/web/figure_data.js.
#include "capstan/printing/printed_page.h"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "capstan/platform/child_process.h"
#include "capstan/platform/files.h"
#include "capstan/platform/work_meter.h"

namespace capstan::printing {

namespace {

constexpr const char* browsers[] = {"chromium", "chromium-browser", "google-chrome", "chrome"};
constexpr std::chrono::seconds browser_time{300};
constexpr int page_time_ms = 120'000;  // of the page's own clock, which does not wait

class BrowserFolder {
  public:
    BrowserFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "capstan-print-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr)
            throw std::runtime_error("cannot make a temporary folder for the browser");
        path_ = name;
    }
    ~BrowserFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    BrowserFolder(const BrowserFolder&) = delete;
    BrowserFolder& operator=(const BrowserFolder&) = delete;

    std::filesystem::path operator/(const char* name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

// The page says "capstan: 3 of 20 drawn" on its console; the browser needs some time after the last one, too.
std::optional<double> fraction_drawn(const std::string& line) {
    constexpr double finishing = 0.05;
    int done = 0;
    int all = 0;
    const std::size_t at = line.find("capstan: ");
    if (at == std::string::npos ||
        std::sscanf(line.c_str() + at, "capstan: %d of %d drawn", &done, &all) != 2 || all <= 0)
        return std::nullopt;
    return (1.0 - finishing) * std::min(done, all) / all;
}

// What the browser writes when it has opened `page_html` in the folder.
std::string opened(const BrowserFolder& folder, const std::string& page_html, const std::string& what,
                   const std::string& part_of_page) {
    const std::string browser = browser_on_path();
    if (browser.empty())
        throw std::runtime_error(
            "this needs a browser such as chromium on PATH (Debian: apt-get install chromium)");
    write_file(folder / "page.html", page_html);
    std::vector<std::string> words{browser,
                                   "--headless",
                                   "--disable-gpu",
                                   "--no-first-run",
                                   "--disable-extensions",
                                   "--no-pdf-header-footer",
                                   fmt::format("--user-data-dir={}", (folder / "profile").string()),
                                   fmt::format("--virtual-time-budget={}", page_time_ms),
                                   "--enable-logging=stderr",
                                   "--log-level=0",
                                   what};
    if (::geteuid() == 0) words.insert(words.begin() + 1, "--no-sandbox");  // else it refuses to run as root
    words.push_back("file://" + (folder / "page.html").string() + part_of_page);
    ChildProcess process(words);
    std::string messages;
    double drawn = 0.0;
    expect_work(1.0);
    const CommandOutput ended = process.wait(
        [&](const std::string& line) {
            const auto fraction = fraction_drawn(line);
            if (!fraction) messages += line + "\n";
            if (fraction && *fraction > drawn) {
                note_work(*fraction - drawn);
                drawn = *fraction;
            }
        },
        {.longest = browser_time});
    if (ended.exit_code != 0)
        throw std::runtime_error(
            fmt::format("{} failed (exit code {}): {}", browser, ended.exit_code, messages.substr(0, 500)));
    return ended.output;
}

std::string decoded(const std::string& base64) {
    std::string bytes(base64.size() / 4 * 3 + 4, '\0');
    const int size = ::EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                                       reinterpret_cast<const unsigned char*>(base64.data()),
                                       static_cast<int>(base64.size()));
    if (size < 0) throw std::runtime_error("the browser left damaged figures");
    const std::size_t padding = base64.ends_with("==") ? 2 : base64.ends_with("=") ? 1 : 0;
    bytes.resize(static_cast<std::size_t>(size) - padding);
    return bytes;
}

}  // namespace

std::string browser_on_path() {
    for (const char* name : browsers) {
        if (is_on_path(name)) return name;
    }
    return "";
}

std::string pdf_of(const std::string& page_html) {
    const BrowserFolder folder;
    opened(folder, page_html, "--print-to-pdf=" + (folder / "page.pdf").string(), "#paper");
    return read_file(folder / "page.pdf");
}

std::vector<FigureFile> figures_of(const std::string& page_html, int width_px) {
    constexpr std::string_view begin = "<pre id=\"figure-files\">";
    const BrowserFolder folder;
    const std::string page = opened(folder, page_html, "--dump-dom", fmt::format("#figures={}", width_px));
    const std::size_t at = page.rfind(begin);
    const std::size_t end = at == std::string::npos ? at : page.find('<', at + begin.size());
    if (end == std::string::npos) throw std::runtime_error("the browser could not draw the figures");
    std::vector<FigureFile> files;
    const auto drawn =
        nlohmann::json::parse(decoded(page.substr(at + begin.size(), end - at - begin.size())));
    for (const auto& figure : drawn) {
        const auto name = figure.at("name").get<std::string>();
        const auto png = figure.at("png").get<std::string>();
        files.push_back({name + ".svg", figure.at("svg").get<std::string>() + "\n"});
        files.push_back({name + ".png", decoded(png.substr(png.find(',') + 1))});
    }
    return files;
}

}  // namespace capstan::printing
