// Writes the report pages that the browser test opens: make_sample_report FOLDER

#include <filesystem>
#include <fstream>
#include <iostream>

#include "capstan/reports/study_report.h"
#include "sample_study.h"

namespace {

void write_page(const std::filesystem::path& folder, const std::string& name,
                const capstan::sample::SampleOptions& options) {
    const auto results = folder / (name + ".db");
    std::filesystem::remove(results);
    const std::int64_t study_id = capstan::sample::add_sample_study(results, options);
    auto database = capstan::storage::Database::open_read_only(results);
    std::ofstream(folder / (name + ".html")) << capstan::reports::study_report_html(database, study_id);
}

}  // namespace

int main(int argument_count, char** arguments) try {
    if (argument_count != 2) {
        std::cerr << "usage: make_sample_report FOLDER\n";
        return 2;
    }
    const std::filesystem::path folder = arguments[1];
    std::filesystem::create_directories(folder);
    write_page(folder, "paper", {});
    write_page(folder, "several_noise_levels",
               {.name = "Wrist <b>& \"hand\"</b></script>",
                .with_paper_comparison = false,
                .noise_levels = 3,
                .mixed_bends = true});
    write_page(folder, "mass_only",
               {.name = "Mass motion only",
                .with_partial_regime = false,
                .with_paper_comparison = false,
                .with_node_errors = false});
    return 0;
} catch (const std::exception& problem) {
    std::cerr << problem.what() << "\n";
    return 1;
}
