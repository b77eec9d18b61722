#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace capstan {

/// A ZIP archive of XML, such as an office document; its parts are unpacked as they are read. What unpacks to
/// far more than XML of numbers does is refused, and so is XML with a document type, which could define
/// entities.
class XmlArchive {
  public:
    using Attributes = std::map<std::string, std::string>;  // without prefixes of namespaces

    /// What is called as a part is read; `end` and `text` may be empty.
    struct Handlers {
        std::function<void(const std::string& name, const Attributes& attributes)> begin{};
        std::function<void(const std::string& name)> end{};
        std::function<void(std::string_view text)> text{};
    };

    /// `what`: what the archive should be, with its article, for messages. Throws InvalidInput where it is
    /// cut or damaged.
    XmlArchive(const std::filesystem::path& path, std::string what);

    /// Reads a part element by element; false if the part is missing. Throws InvalidInput.
    bool parse(const std::string& part, const Handlers& handlers);

    /// Throws InvalidInput with the file's name before `why`.
    [[noreturn]] void refuse(std::string_view why) const;

  private:
    struct Reading;
    void feed(const std::string& part, Reading& reading);

    std::filesystem::path path_;
    std::string what_;
    std::unique_ptr<void, int (*)(void*)> file_;
    std::uint64_t packed_bytes_;
    std::uint64_t unpacked_bytes_ = 0;
};

}  // namespace capstan
