#include "capstan/import/log_runs.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/log_files.h"
#include "capstan/import/log_times.h"
#include "capstan/platform/nearest_name.h"

namespace capstan::imports {

namespace {

using logs::Log;
using logs::LogColumn;
using logs::LogTable;

bool matches(const std::string& pattern, const std::string& name) {
    return pattern.empty() || ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

std::string columns_in_words(const std::vector<const Log*>& logs, const ColumnPlace& wanted) {
    std::vector<std::string> names;
    std::vector<std::string> tables;
    std::string list;
    for (const Log* log : logs) {
        for (const LogTable& table : log->tables) {
            tables.push_back(table.name);
            for (const LogColumn& column : table.columns) {
                names.push_back(column.name);
                if (list.size() < 600)
                    list += fmt::format("{}{}{}", list.empty() ? "" : ", ",
                                        table.name.empty() ? "" : table.name + " ", column.name);
            }
        }
    }
    const bool has_table =
        wanted.table.empty() || std::find(tables.begin(), tables.end(), wanted.table) != tables.end();
    const auto nearest = has_table ? nearest_name(wanted.column, names) : nearest_name(wanted.table, tables);
    if (nearest)
        return fmt::format("; {}did you mean \"{}\"?", has_table ? "" : "there is no such table, ", *nearest);
    return list.empty() ? "; the file has no column of numbers" : "; the columns are: " + list;
}

struct FoundColumn {
    const Log* log = nullptr;
    const LogTable* table = nullptr;
    const LogColumn* column = nullptr;
};

// Every column that a place fits.
std::vector<FoundColumn> columns_at(const std::vector<const Log*>& logs, const ColumnPlace& place) {
    std::vector<FoundColumn> found;
    for (const Log* log : logs) {
        if (!matches(place.file, log->file.filename().string())) continue;
        for (const LogTable& table : log->tables) {
            if (!place.table.empty() && table.name != place.table) continue;
            const int column = find_column(table, place.column);
            if (column >= 0) found.push_back({log, &table, &table.columns[static_cast<std::size_t>(column)]});
        }
    }
    return found;
}

/// Finds the sources of one run's channels.
class SourceFinder {
  public:
    SourceFinder(const Mapping& mapping, std::vector<const Log*> logs, ProblemList& problems)
        : mapping_(&mapping), logs_(std::move(logs)), problems_(&problems) {}

    std::optional<Source> source(const ChannelMapping& channel, const RunMapping* run) {
        const std::vector<FoundColumn> found = columns_at(logs_, channel.from);
        const std::string key = "channels." + channel.name;
        if (found.empty()) {
            problem(key, fmt::format("no column \"{}\"{} in {}{}", channel.from.column,
                                     channel.from.table.empty() ? "" : " of " + channel.from.table, files(),
                                     columns_in_words(logs_, channel.from)));
            return std::nullopt;
        }
        if (found.size() > 1) {
            problem(key, fmt::format("\"{}\" is in {} tables of {}; state `table` (a topic) or `file`",
                                     channel.from.column, found.size(), files()));
            return std::nullopt;
        }
        Source source;
        source.mapping = &channel;
        source.column = found[0].column;
        source.factor = channel.factor();
        source.zero = channel.zero;
        source.clock_offset_s = channel.clock_offset_s.value_or(0.0);
        source.wraps_at = channel.wraps_at.value_or(0.0);
        if (run != nullptr) {
            for (const auto& [name, zero] : run->zero) {
                if (name == channel.name) source.zero = zero;
            }
        }
        if (!find_clock(found[0], source.clock)) return std::nullopt;
        return source;
    }

  private:
    bool find_clock(const FoundColumn& found, Clock& clock) {
        const TimeMapping& time = mapping_->time;
        clock.table = found.table;
        if (time.sample_rate_Hz > 0.0) {
            clock.sample_rate_Hz = time.sample_rate_Hz;
            return true;
        }
        clock.column = time_column(*found.table, time.column);
        if (clock.column < 0) {
            if (said_.insert(found.table).second)
                problem("time.column",
                        time.column.empty()
                            ? fmt::format("no column of {} looks like times; name it, or state "
                                          "time.sample_rate_Hz if the log has none",
                                          files())
                            : fmt::format("no column \"{}\" in {}{}{}", time.column, files(),
                                          found.table->name.empty() ? "" : " " + found.table->name,
                                          columns_in_words({found.log}, {"", "", time.column})));
            return false;
        }
        const LogColumn& column = found.table->columns[static_cast<std::size_t>(clock.column)];
        clock.seconds = seconds_per_unit(column, time.unit);
        return true;
    }

    std::string files() const {
        std::vector<std::filesystem::path> files;
        for (const Log* log : logs_) files.push_back(log->file);
        return file_names(files);
    }

    void problem(const std::string& key, const std::string& what) {
        problems_->add(mapping_->file.empty() ? "mapping" : mapping_->file, key + ": " + what);
    }

    const Mapping* mapping_;
    std::vector<const Log*> logs_;
    ProblemList* problems_;
    std::set<const LogTable*> said_;
};

// Which columns an import needs.
std::function<bool(const std::string&, const std::string&)> wanted_by(const Mapping& mapping) {
    const bool by_number =
        std::any_of(mapping.channels.begin(), mapping.channels.end(), [](const ChannelMapping& channel) {
            return std::all_of(channel.from.column.begin(), channel.from.column.end(), ::isdigit);
        });
    // Numbers count all columns, and a time without a name is searched among all.
    if (by_number || (mapping.time.column.empty() && mapping.time.sample_rate_Hz == 0.0)) return {};
    std::set<std::string> names = {mapping.time.column, mapping.run_column.value_or(mapping.time.column)};
    for (const ChannelMapping& channel : mapping.channels) names.insert(channel.from.column);
    return [names](const std::string&, const std::string& column) { return names.count(column) > 0; };
}

struct FileGroup {
    const RunMapping* mapping = nullptr;
    std::vector<std::filesystem::path> files;
};

std::vector<FileGroup> groups_of(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                                 ProblemList& problems) {
    std::vector<FileGroup> groups;
    std::set<std::filesystem::path> used;
    // Runs that a column numbers are found in every file.
    const bool without_files =
        mapping.runs.empty() ||
        (mapping.run_column && std::all_of(mapping.runs.begin(), mapping.runs.end(),
                                           [](const RunMapping& run) { return run.files.empty(); }));
    for (std::size_t number = 0; !without_files && number < mapping.runs.size(); ++number) {
        const RunMapping& run = mapping.runs[number];
        FileGroup group{&run, {}};
        for (const std::string& name : run.files) {
            const auto found = std::find_if(files.begin(), files.end(), [&](const auto& file) {
                return matches(name, file.filename().string());
            });
            if (found == files.end()) {
                problems.add(mapping.file,
                             fmt::format("runs[{}].file: \"{}\" is not among the files given; name it on "
                                         "the command line",
                                         number + 1, name));
                continue;
            }
            group.files.push_back(*found);
            used.insert(*found);
        }
        if (run.files.empty()) {
            group.files = files.size() == 1 ? files : std::vector<std::filesystem::path>{};
            if (files.size() > 1 && number < files.size()) group.files = {files[number]};
            used.insert(group.files.begin(), group.files.end());
            if (group.files.empty())
                problems.add(
                    mapping.file,
                    fmt::format("runs[{}]: state which `file` it is in; there are more runs than files",
                                number + 1));
        }
        groups.push_back(group);
    }
    if (without_files) {
        const bool joined = std::any_of(mapping.channels.begin(), mapping.channels.end(),
                                        [](const auto& channel) { return !channel.from.file.empty(); });
        if (joined) return {{nullptr, files}};  // the channels of one run come from several files
        for (const auto& file : files) groups.push_back({nullptr, {file}});
        return groups;
    }
    for (const auto& file : files) {
        if (used.count(file) == 0)
            problems.add(file.string(),
                         "is in no run of the mapping; add a [[runs]] with this `file`, or leave it out");
    }
    return groups;
}

// A run for each stretch of the log.
void add_stretches(const FileGroup& group, const Mapping& mapping, std::vector<Source> sources,
                   LogRuns& found) {
    LogRun run{group.mapping, group.files, std::move(sources), {}, nullptr, 0.0, 0.0};
    const Clock& clock = run.sources.front().clock;
    const bool one_table = std::all_of(run.sources.begin(), run.sources.end(), [&](const Source& source) {
        return source.clock.table == clock.table;
    });
    if (!one_table) {
        found.runs.push_back(std::move(run));
        return;
    }
    if (mapping.run_column) {
        const int column = clock.table->column(*mapping.run_column);
        if (column >= 0) run.run_column = &clock.table->columns[static_cast<std::size_t>(column)];
    }
    for (const RowRange& rows : row_ranges(clock, run.run_column)) {
        LogRun stretch = run;
        stretch.rows = rows;
        if (run.run_column != nullptr)
            logs::NumberReader(run.run_column->values, rows.first).next(stretch.run_value);
        found.runs.push_back(std::move(stretch));
    }
}

using Wanted = std::function<bool(const std::string& table, const std::string& column)>;

LogRuns read_wanted(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                    const Wanted& wanted, const std::function<void(double)>& on_progress,
                    ProblemList& problems) {
    LogRuns found;
    const std::vector<FileGroup> groups = groups_of(files, mapping, problems);
    problems.throw_if_any();
    logs::ReadOptions options;
    options.wanted = wanted;
    options.text = mapping.text;
    found.logs = read_logs(files, options, on_progress);
    std::map<std::filesystem::path, const Log*> logs;
    for (const auto& log : found.logs) {
        logs[log->file] = log.get();
        for (const std::string& remark : log->remarks)
            found.findings.push_back({.kind = FindingKind::unread,
                                      .words = fmt::format("{}: {}", log->file.filename().string(), remark)});
        for (const std::string& assumption : log->assumptions)
            found.findings.push_back(
                {.kind = FindingKind::assumed,
                 .words = fmt::format("{}: {}", log->file.filename().string(), assumption)});
    }
    for (const FileGroup& group : groups) {
        std::vector<const Log*> group_logs;
        for (const auto& file : group.files) group_logs.push_back(logs.at(file));
        SourceFinder finder(mapping, group_logs, problems);
        std::vector<Source> sources;
        for (const ChannelMapping& channel : mapping.channels) {
            if (auto source = finder.source(channel, group.mapping)) sources.push_back(*source);
        }
        if (sources.size() == mapping.channels.size())
            add_stretches(group, mapping, std::move(sources), found);
    }
    problems.throw_if_any();
    return found;
}

}  // namespace

LogRuns read_log_runs(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                      const std::function<void(double)>& on_progress, ProblemList& problems) {
    const Wanted wanted = wanted_by(mapping);
    const std::size_t before = problems.size();
    try {
        return read_wanted(files, mapping, wanted, on_progress, problems);
    } catch (const InvalidInput&) {
        if (!wanted || problems.size() == before) throw;
    }
    ProblemList again;  // with every column, so that the messages name them
    return read_wanted(files, mapping, {}, on_progress, again);
}

}  // namespace capstan::imports
