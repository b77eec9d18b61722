#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace capstan::cli {

/// A file whose text comes piece by piece, and which is written whole or not at all: without finish() it is
/// not there, or as it was.
class WholeFile {
  public:
    explicit WholeFile(const std::filesystem::path& path);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    void append(std::string_view text);
    void finish();

  private:
    void write_pieces();

    std::filesystem::path named_;  // as it was asked for
    std::filesystem::path path_;   // that gets the text in the end
    std::string temporary_;        // '': a pipe or the like, written at once
    std::string pieces_;           // not written yet
    int descriptor_ = -1;
};

}  // namespace capstan::cli
