// Delimited text: comma, semicolon, tab, blanks; with or without a head.
#include <fmt/format.h>

#include <algorithm>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/text_lines.h"
#include "capstan/logs/text_table.h"

namespace capstan::logs {

namespace {

constexpr std::size_t sample_lines = 1000;
constexpr std::size_t sample_bytes = 1u << 20;

bool is_text(std::string_view head, const std::filesystem::path&) {
    std::string unpacked;
    if (is_gzip(head)) head = unpacked = unpacked_head(head);
    if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) return true;
    return !head.empty() && std::none_of(head.begin(), head.end(), [](char letter) {
        const auto byte = static_cast<unsigned char>(letter);
        return byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r' && byte != '\f' && byte != 0x1a;
    });
}

std::vector<std::string> first_lines(TextLines& lines) {
    std::vector<std::string> sample;
    std::size_t bytes = 0;
    std::string_view line;
    while (sample.size() < sample_lines && bytes < sample_bytes && lines.next(line)) {
        bytes += line.size();
        sample.emplace_back(line);
    }
    return sample;
}

void read_text(const std::filesystem::path& path, const ReadOptions& options, Log& log) {
    TextLines lines(open_source(path, options.on_progress), path);
    const std::vector<std::string> sample = first_lines(lines);
    const bool all_read = lines.is_unfinished();
    if (sample.empty()) throw InvalidInput({fmt::format("{}: has no lines", path.string())});
    const TextLayout layout = find_layout(sample, options.text, path.string());
    log.text = {layout.style.delimiter, layout.style.decimal_comma, layout.head_line, options.text.comments};
    TableWriter writer(log, options);
    TextTable table(layout, writer, "");
    for (std::size_t line = layout.first_data_line; line <= sample.size(); ++line)
        table.take(sample[line - 1], line, all_read && line == sample.size());
    for (std::string_view line; lines.next(line);) table.take(line, lines.number(), lines.is_unfinished());
    table.end();
    if (lines.is_cut()) writer.remark("The compressed file is cut; the lines before that are read");
}

}  // namespace

const LogFormat text_format{"delimited text", ".csv, .txt, .tsv, .dat, also packed with gzip", is_text,
                            read_text};

}  // namespace capstan::logs
