#pragma once
// The frame of every page: head, style, navigation, the scripts that draw its figures. A page loads nothing;
// a page that a service sends loads from that service alone.

#include <string>
#include <vector>

namespace capstan::reports {

// Plain text, except for the members that end in _html or _json.
struct PageFrame {
    std::string document_title;
    std::string kind;  // above the title: 'Sensor placement study'
    std::string title;
    std::string verdict;  // the page in one sentence
    std::string navigation_html;
    std::string main_html;
    std::string footer;
    std::string data_json;  // of page_data
};

enum class PageFiles {
    inside,  // the page is one self-contained file
    served,  // style and scripts come from the service that sent the page, which adds its own
};

/// The scripts of every page, in the order in which they run.
inline constexpr const char* page_scripts[] = {"vega.min.js", "vega-lite.min.js", "vega-embed.min.js",
                                               "page.js",     "figure_data.js",   "player.js",
                                               "brush.js"};

/// Of this build, "0.2.0".
std::string program_version();

std::string page_html(const PageFrame& frame, PageFiles files = PageFiles::inside);

// '' without content; `intro` is plain text.
std::string section_html(const std::string& id, const std::string& title, const std::string& intro,
                         const std::string& content);

struct SectionLink {
    std::string id;
    std::string title;
};

// Links to the sections that are on the page, followed by `extra_html`.
std::string navigation_html(const std::string& main_html, const std::vector<SectionLink>& links,
                            const std::string& extra_html);

}  // namespace capstan::reports
