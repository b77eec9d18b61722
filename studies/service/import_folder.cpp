#include "capstan/service/import_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>

#include "capstan/platform/child_process.h"
#include "capstan/platform/files.h"
#include "capstan/service/job_results.h"

namespace capstan::service {

namespace {

constexpr std::chrono::seconds import_limit{120};
constexpr ChildLimits import_process{.nice_increment = 5, .memory_bytes = 2UL << 30, .processor_s = 240};
constexpr std::size_t max_import_output = 16 << 20;
constexpr std::size_t longest_name = 120;

// Runs a command and ends it after `import_limit`.
CommandOutput run_limited(const std::vector<std::string>& words, const std::atomic<bool>* ending) {
    CommandOutput output = run_command(words, import_process, {import_limit, max_import_output, ending});
    if (output.is_late)
        throw BadRequest(
            fmt::format(
                "the import took more than {} s; use `capstan import` at the shell for logs as long as this",
                import_limit.count()),
            408);
    if (output.is_long) throw BadRequest("the import wrote more than a page can show", 413);
    return output;
}

}  // namespace

PrivateFolder::PrivateFolder(const std::string& name) {
    std::string path = (std::filesystem::temp_directory_path() / (name + "-XXXXXX")).string();
    if (::mkdtemp(path.data()) == nullptr)
        throw std::runtime_error("cannot make a folder in " +
                                 std::filesystem::temp_directory_path().string());
    path_ = path;
}

PrivateFolder::~PrivateFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string safe_file_name(const std::string& name) {
    std::string safe = name.substr(name.find_last_of("/\\") + 1);
    for (char& letter : safe) {
        const auto byte = static_cast<unsigned char>(letter);
        if (byte < 32 || byte == 127 || std::string_view("*?:\"<>|").find(letter) != std::string_view::npos)
            letter = '_';
    }
    if (safe.size() > longest_name) safe = safe.substr(safe.size() - longest_name);
    if (safe.starts_with('.')) safe[0] = '_';
    return safe.empty() ? "log" : safe;
}

ImportFolder::ImportFolder(const http::Request& request, const JobCommands& commands)
    : private_("capstan-import"), program_(commands.program), ending_(commands.ending) {
    std::vector<const http::FormPart*> logs;
    for (const http::FormPart& part : request.parts)
        if (part.name == "log") logs.push_back(&part);
    if (logs.empty())
        throw BadRequest("the part 'log' is missing: send each file of the log as a part 'log'");
    if (logs.size() > max_uploaded_logs)
        throw BadRequest(
            fmt::format("{} files; at most {} are taken at once", logs.size(), max_uploaded_logs), 413);
    std::vector<std::string> names;
    for (const http::FormPart* part : logs) {
        const std::string name = safe_file_name(part->filename);
        if (std::find(names.begin(), names.end(), name) != names.end())
            throw BadRequest(fmt::format("two files are called {}; give them different names", name));
        names.push_back(name);
    }
    std::filesystem::create_directory(folder() / "logs");
    for (std::size_t k = 0; k < logs.size(); ++k) {
        logs_.push_back(folder() / "logs" / names[k]);
        write_file(logs_.back(), logs[k]->content);
    }
    const http::FormPart* mapping = request.part("mapping");
    has_mapping_ = mapping != nullptr;
    if (has_mapping_) write_file(folder() / "import.toml", mapping->content);
}

std::string ImportFolder::import(const std::vector<std::string>& words) const {
    std::vector<std::string> command{program_, "import"};
    for (const auto& log : logs_) command.push_back(log.string());
    command.insert(command.end(), {"--progress", "none"});
    command.insert(command.end(), words.begin(), words.end());
    const CommandOutput ended = run_limited(command, ending_);
    if (ended.exit_code == 0) return ended.output;
    std::string messages =
        plain_messages(plain_messages(ended.messages, (folder() / "logs").string()), folder().string());
    throw BadRequest(messages.empty() ? fmt::format("the import ended with code {}", ended.exit_code)
                                      : messages);
}

std::filesystem::path ImportFolder::import_recording(std::string& answer) const {
    if (!has_mapping_) throw BadRequest("the part 'mapping' is missing: send the text of import.toml");
    const std::filesystem::path recording = folder() / "recording";
    answer = import({"--mapping", (folder() / "import.toml").string(), "-o", recording.string(), "--json"});
    return recording.string() + ".csv";
}

}  // namespace capstan::service
