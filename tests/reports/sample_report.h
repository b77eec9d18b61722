#pragma once
// A sample study in a temporary database, opened as a report opens it.

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "capstan/storage/database.h"
#include "sample_study.h"

namespace capstan::sample {

inline bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

class SampleReport {
  public:
    explicit SampleReport(const SampleOptions& options = {})
        : folder_(new_folder()),
          study_id(add_sample_study(folder_ / "sample.db", options)),
          database(storage::Database::open_read_only(folder_ / "sample.db")) {}
    ~SampleReport() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    SampleReport(const SampleReport&) = delete;
    SampleReport& operator=(const SampleReport&) = delete;

  private:
    static std::filesystem::path new_folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "capstan-report-XXXXXX").string();
        return mkdtemp(pattern.data());
    }
    std::filesystem::path folder_;

  public:
    std::int64_t study_id;
    storage::Database database;
};

}  // namespace capstan::sample
