#include "capstan/xml_archive/xml_archive.h"

#include <expat.h>
#include <fmt/format.h>
#include <minizip/unzip.h>

#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan {

namespace {

constexpr std::uint64_t free_unpacked_bytes = 64u << 20;
constexpr std::uint64_t largest_zip_ratio = 200;  // XML of numbers packs ten to forty times

std::string name_without_prefix(std::string_view name) {
    return std::string(name.substr(name.rfind(':') + 1));  // npos + 1 is 0
}

}  // namespace

struct XmlArchive::Reading {
    const Handlers& handlers;
    std::unique_ptr<std::remove_pointer_t<XML_Parser>, void (*)(XML_Parser)> parser;
};

XmlArchive::XmlArchive(const std::filesystem::path& path, std::string what)
    : path_(path),
      what_(std::move(what)),
      file_(unzOpen64(path.c_str()), unzClose),
      packed_bytes_(std::filesystem::file_size(path)) {
    if (!file_) refuse("is a ZIP archive that is cut or damaged; copy the file again");
}

void XmlArchive::refuse(std::string_view why) const {
    throw InvalidInput({fmt::format("{}: {}", path_.string(), why)});
}

bool XmlArchive::parse(const std::string& part, const Handlers& handlers) {
    if (unzLocateFile(file_.get(), part.c_str(), 1) != UNZ_OK) return false;
    if (unzOpenCurrentFile(file_.get()) != UNZ_OK) refuse(part + " in it cannot be unpacked");
    Reading reading{handlers, {XML_ParserCreate(nullptr), XML_ParserFree}};
    if (!reading.parser) throw std::bad_alloc();
    XML_Parser parser = reading.parser.get();
    XML_SetUserData(parser, &reading);
    XML_SetElementHandler(
        parser,
        [](void* to, const char* name, const char** pairs) {
            Attributes attributes;
            for (; pairs[0]; pairs += 2) attributes[name_without_prefix(pairs[0])] = pairs[1];
            static_cast<Reading*>(to)->handlers.begin(name_without_prefix(name), attributes);
        },
        [](void* to, const char* name) {
            if (const auto& end = static_cast<Reading*>(to)->handlers.end) end(name_without_prefix(name));
        });
    XML_SetCharacterDataHandler(parser, [](void* to, const char* text, int length) {
        if (const auto& take = static_cast<Reading*>(to)->handlers.text)
            take({text, static_cast<std::size_t>(length)});
    });
    XML_SetStartDoctypeDeclHandler(parser, [](void* to, const char*, const char*, const char*, int) {
        XML_StopParser(static_cast<Reading*>(to)->parser.get(), XML_FALSE);
    });
    feed(part, reading);
    unzCloseCurrentFile(file_.get());
    return true;
}

void XmlArchive::feed(const std::string& part, Reading& reading) {
    std::vector<char> block(1u << 16);
    for (int got = 1; got > 0;) {
        got = unzReadCurrentFile(file_.get(), block.data(), static_cast<unsigned>(block.size()));
        if (got < 0) refuse(part + " in it is damaged");
        unpacked_bytes_ += static_cast<std::uint64_t>(got);
        if (unpacked_bytes_ > free_unpacked_bytes + largest_zip_ratio * packed_bytes_)
            refuse("unpacks to far more than " + what_ + " does");
        if (XML_Parse(reading.parser.get(), block.data(), got, got == 0) != XML_STATUS_OK)
            refuse(fmt::format("{} in it is not XML of {}, in line {}", part, what_,
                               XML_GetCurrentLineNumber(reading.parser.get())));
    }
}

}  // namespace capstan
