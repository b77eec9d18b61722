#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/importer.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::imports {

/// Logs in a folder of a test's own, and what an import makes of them.
class ImportTest : public testing::Test {
  protected:
    ImportTest()
        : folder_(std::filesystem::temp_directory_path() /
                  ("capstan_import_" +
                   std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~ImportTest() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    std::string text_of(const std::string& name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
        return text.str();
    }
    ImportReport import(const std::vector<std::filesystem::path>& files, const std::string& mapping,
                        const ImportOptions& options = {}) {
        return import_logs(files, parse_mapping(mapping, "import.toml"), folder_ / "out", options);
    }
    Recording imported() const { return read_recording(folder_ / "out.csv"); }
    /// Every problem that importing meets; empty if it goes well.
    std::string refusal(const std::vector<std::filesystem::path>& files, const std::string& mapping,
                        const ImportOptions& options = {}) {
        try {
            import(files, mapping, options);
            return "";
        } catch (const InvalidInput& error) {
            std::string all;
            for (const std::string& problem : error.problems()) all += problem + "\n";
            return all;
        }
    }

    std::filesystem::path folder_;
};

/// A finding of that kind, or a failure.
inline Finding finding_of(const ImportReport& report, FindingKind kind) {
    for (const Finding& finding : report.findings) {
        if (finding.kind == kind) return finding;
    }
    ADD_FAILURE() << "no finding of the kind " << finding_name(kind);
    return {};
}

}  // namespace capstan::imports
