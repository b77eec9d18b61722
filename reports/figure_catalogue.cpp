#include "capstan/reports/figure_catalogue.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "capstan/reports/embedded_files.h"

namespace capstan::reports {
namespace {

constexpr std::string_view ending = ".vl.json";

// '20_error_matrix.vl.json' -> 'error_matrix'
std::string id_of(std::string_view file_name) {
    file_name.remove_suffix(ending.size());
    return std::string(file_name.substr(file_name.find('_') + 1));
}

Figure read_figure(const EmbeddedFile& file) {
    const auto spec = nlohmann::json::parse(file.text);
    const auto& about = spec.at("usermeta").at("capstan");
    Figure figure;
    figure.id = id_of(file.name);
    figure.spec = spec.dump();
    figure.page = about.value("page", "study");
    figure.section = about.at("section");
    figure.title = about.at("title");
    figure.paper = about.value("paper", std::map<std::string, std::string>{});
    figure.caption = about.at("caption");
    figure.per = about.at("per");
    figure.tables = about.at("tables").get<std::vector<std::string>>();
    figure.knowledge = about.value("knowledge", std::vector<std::string>{});
    figure.panel_height_px = about.at("panel_height_px");
    figure.frame_height_px = about.at("frame_height_px");
    figure.row_frame_height_px = about.value("row_frame_height_px", 0);
    figure.rows_by = about.value("rows_by", "");
    return figure;
}

}  // namespace

const std::vector<Figure>& figures() {
    static const std::vector<Figure> list = [] {
        std::vector<Figure> found;
        for (const EmbeddedFile& file : embedded_files()) {
            if (file.name.size() > ending.size() &&
                file.name.substr(file.name.size() - ending.size()) == ending) {
                found.push_back(read_figure(file));
            }
        }
        return found;
    }();
    return list;
}

}  // namespace capstan::reports
