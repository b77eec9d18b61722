#include <fmt/format.h>

#include <algorithm>

#include "capstan/answers/recording_answers.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/recording/recording_keys.h"

namespace capstan::answers {

namespace {

using reports::Data;

constexpr std::size_t drawn_import_samples = 15000;

Data findings_data(const std::vector<imports::Finding>& findings) {
    Data rows = Data::list();
    for (const imports::Finding& finding : findings) {
        rows.push_back({{"what", finding_name(finding.kind)},
                        {"repaired", finding.repaired},
                        {"done", finding.repaired ? "repaired" : "not changed"},
                        {"run", finding.log_run == 0 ? Data() : Data(finding.log_run)},
                        {"channel", finding.channel},
                        {"count", finding.count},
                        {"amount", finding.amount},
                        {"uncertainty", finding.uncertainty},
                        {"words", finding.words}});
    }
    return rows;
}

reports::Table drawn_channels(const Recording& recording) {
    reports::Table table{
        "channel", "The channels of the recording", {"run", "channel", "time_s", "series", "value"}, {}};
    const std::size_t curves = recording.channels.size() * std::max<std::size_t>(recording.runs.size(), 1);
    const std::size_t limit =
        std::max<std::size_t>(drawn_import_samples / std::max<std::size_t>(curves, 1), 100);
    for (const RecordedRun& run : recording.runs) {
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            const std::string name =
                fmt::format("{} [{}]", recording.channels[channel].name, recording.channels[channel].unit);
            for (std::size_t k = 0; k < run.time_s.size();
                 k += reports::drawn_every(run.time_s.size(), limit))
                table.rows.push_back(
                    {std::int64_t{run.number}, name, run.time_s[k], "measured", run.values[channel][k]});
        }
    }
    return table;
}

// "roll_deg -45, load 2"
std::string condition_words(const RecordedRun& run) {
    std::string words;
    for (const auto& [name, value] : run.conditions)
        words += fmt::format("{}{} {:g}", words.empty() ? "" : ", ", name, value);
    return words;
}

}  // namespace

reports::Answer import_answer(const imports::ImportReport& report) {
    reports::Answer answer{.id = "import", .kind = "Import of a log", .title = report.recording.name};
    std::size_t samples = 0;
    Data runs = Data::list();
    reports::Table drawn_runs{"run", "Runs of the recording", {"run", "protocol", "samples"}, {}};
    for (const imports::ImportedRun& run : report.runs) {
        samples += run.samples;
        runs.push_back({{"run", run.number},
                        {"source", run.source},
                        {"samples", run.samples},
                        {"duration_s", run.duration_s}});
        drawn_runs.rows.push_back(
            {std::int64_t{run.number}, run.source, static_cast<std::int64_t>(run.samples)});
    }
    const auto repairs =
        static_cast<std::size_t>(std::count_if(report.findings.begin(), report.findings.end(),
                                               [](const auto& finding) { return finding.repaired; }));
    const std::size_t doubts = report.findings.size() - repairs;
    answer.headline =
        fmt::format("{} with {} samples of {} at {:g} Hz; {}, {}.", counted(report.runs.size(), "run"),
                    samples, counted(report.channels.size(), "channel"), report.sample_rate_Hz,
                    counted(repairs, "repair"), counted(doubts, "remark"));
    const Data findings = findings_data(report.findings);
    answer.values = {{"files", report.files},
                     {"channels", report.channels},
                     {"sample_rate_hz", report.sample_rate_Hz},
                     {"samples", samples},
                     {"runs", runs},
                     {"findings", findings}};
    answer.sections = {
        {.id = "runs",
         .heading = "Runs",
         .tables = {{"runs",
                     "",
                     {{"run", "run"},
                      {"source", "from"},
                      {"samples", "samples"},
                      {"duration_s", "time", "s", ".4g"}},
                     runs,
                     40}}},
        {.id = "findings",
         .heading = "What was found in the log",
         .prose = report.findings.empty() ? "Nothing had to be repaired, and nothing looks wrong." : "",
         .tables = {{"findings",
                     "",
                     {{"what", "what"}, {"done", "the recording"}, {"words", "details"}},
                     findings}}}};
    if (report.findings.empty()) answer.sections.back().tables.clear();
    answer.csv_table = "findings";
    answer.drawn = {std::move(drawn_runs), drawn_channels(report.recording)};
    return answer;
}

reports::Answer column_list_answer(const imports::ColumnList& list) {
    reports::Answer answer{.id = "columns",
                           .kind = "Columns of a log",
                           .title = list.logs.front().file,
                           .headline = fmt::format("{} in {}.", counted(list.columns.size(), "column"),
                                                   counted(list.logs.size(), "file"))};
    Data files = Data::list();
    for (const imports::ListedLog& log : list.logs)
        files.push_back({{"file", log.file},
                         {"format", log.format},
                         {"same_columns_as", log.same_columns_as},
                         {"remarks", log.remarks}});
    Data remarks = Data::list();
    for (const imports::ListedLog& log : list.logs)
        for (const std::string& remark : log.remarks)
            remarks.push_back({{"file", log.file}, {"remark", remark}});
    Data columns = Data::list();
    Data shown = Data::list();
    for (const imports::ListedColumn& column : list.columns) {
        Data row = {{"file", column.file},    {"table", column.table}, {"column", column.name},
                    {"unit", column.unit},    {"rows", column.rows},   {"missing", column.missing},
                    {"smallest", column.low}, {"largest", column.high}};
        shown.push_back(row);
        row["drawn_row"] = column.drawn_row;
        row["drawn_value"] = column.drawn_value;
        columns.push_back(std::move(row));
    }
    answer.values = {{"files", files}, {"columns", columns}};
    answer.sections = {{.id = "columns",
                        .heading = "Columns",
                        .tables = {{"columns",
                                    "",
                                    {{"file", "file"},
                                     {"table", "table"},
                                     {"column", "column"},
                                     {"unit", "unit"},
                                     {"rows", "rows"},
                                     {"missing", "missing"},
                                     {"smallest", "smallest"},
                                     {"largest", "largest"}},
                                    shown}}}};
    if (!remarks.items().empty())
        answer.sections.push_back(
            {.id = "remarks",
             .heading = "What was not read, or taken for granted",
             .tables = {{"remarks", "", {{"file", "file"}, {"remark", "remark"}}, remarks}}});
    return answer;
}

reports::AnswerSection assumptions_section(const Recording& recording) {
    Data assumed = Data::list();
    for (const std::string& assumption : recording.assumptions)
        assumed.push_back({{"assumption", assumption}});
    return {.id = "assumptions",
            .heading = "What the sidecar leaves out",
            .tables = {{"assumptions", "", {{"assumption", "what was taken"}}, assumed}}};
}

reports::Answer recording_check_answer(const Recording& recording, const std::vector<std::string>& problems) {
    reports::Answer answer{.id = "recording_check", .kind = "Check of a recording", .title = recording.name};
    Data listed = Data::list();
    for (const std::string& problem : problems) listed.push_back({{"problem", problem}});
    Data runs = Data::list();
    bool any_condition = false;
    for (const RecordedRun& run : recording.runs) {
        any_condition |= !run.conditions.empty();
        Data row = {{"run", run.number},
                    {"protocol", run.protocol},
                    {"samples", run.samples()},
                    {"pretension_N", run.pretension_N}};
        if (!run.conditions.empty()) row["conditions"] = condition_words(run);
        runs.push_back(row);
    }
    Data channels = Data::list();
    for (const Channel& channel : recording.channels)
        channels.push_back({{"channel", channel.name},
                            {"unit", channel.unit},
                            {"noise_std", channel.noise_std},
                            {"step", channel.step}});
    answer.headline =
        problems.empty()
            ? fmt::format("the recording can be used: {}, {}, {} samples.", mode_name(recording.mode),
                          counted(recording.runs.size(), "run"), recording.samples())
            : fmt::format("the recording cannot be used: {}.", counted(problems.size(), "problem"));
    answer.values = {{"ok", problems.empty()},
                     {"problems", problems},
                     {"assumptions", recording.assumptions},
                     {"mode", std::string(mode_name(recording.mode))},
                     {"runs", runs},
                     {"channels", channels}};
    if (!problems.empty())
        answer.sections.push_back({.id = "problems",
                                   .heading = "Problems",
                                   .tables = {{"problems", "", {{"problem", "problem"}}, listed}}});
    if (!recording.assumptions.empty()) answer.sections.push_back(assumptions_section(recording));
    if (problems.empty()) {
        answer.sections.push_back({.id = "channels",
                                   .heading = "Channels",
                                   .tables = {{"channels",
                                               "",
                                               {{"channel", "channel"},
                                                {"unit", "unit"},
                                                {"noise_std", "noise of a reading", "channel's"},
                                                {"step", "step", "channel's"}},
                                               channels}}});
        reports::AnswerTable table = {"runs",
                                      "",
                                      {{"run", "run"},
                                       {"protocol", "protocol"},
                                       {"samples", "samples"},
                                       {"pretension_N", "pretension", "N"}},
                                      runs};
        if (any_condition) table.columns.push_back({"conditions", "conditions"});
        answer.sections.push_back({.id = "runs", .heading = "Runs", .tables = {std::move(table)}});
    }
    return answer;
}

reports::Answer recording_keys_answer() {
    reports::Answer answer{
        .id = "recording_keys",
        .kind = "Keys of a recording",
        .title = "NAME.json",
        .headline =
            "A recording is a table NAME.csv with the columns run, t and one for each channel, and "
            "its description NAME.json."};
    Data keys = Data::list();
    for (const RecordingKey& key : recording_keys()) {
        std::string modes;
        for (int mode = 0; mode <= static_cast<int>(BenchMode::capstan_band); ++mode) {
            if (key.concerns(static_cast<BenchMode>(mode)))
                modes += (modes.empty() ? "" : ", ") + std::string(mode_name(static_cast<BenchMode>(mode)));
        }
        keys.push_back({{"section", key.section.empty() ? "top" : std::string(key.section)},
                        {"name", std::string(key.name)},
                        {"type", std::string(key.type)},
                        {"unit", std::string(key.unit)},
                        {"meaning", std::string(key.meaning)},
                        {"default", key.is_required() ? "required" : std::string(key.default_words)},
                        {"example", std::string(key.example)},
                        {"kinds", key.modes == 15 ? "all" : modes}});
    }
    Data channels = Data::list();
    for (const BenchMode mode : {BenchMode::pull_pull, BenchMode::capstan_band}) {
        for (const KnownChannel& channel : known_channels(mode))
            channels.push_back({{"name", std::string(channel.name)},
                                {"unit", std::string(channel.unit)},
                                {"meaning", std::string(channel.meaning)}});
    }
    channels.push_back({{"name", "tension_..."},
                        {"unit", "N"},
                        {"meaning", "a tension sensor; its place is in tension_sensors"}});
    Data kinds = Data::list();
    for (int mode = 0; mode <= static_cast<int>(BenchMode::capstan_band); ++mode) {
        std::string driven;
        for (const std::string& channel : usual_driven_channels(static_cast<BenchMode>(mode)))
            driven += (driven.empty() ? "" : ", ") + channel;
        kinds.push_back({{"mode", std::string(mode_name(static_cast<BenchMode>(mode)))}, {"driven", driven}});
    }
    answer.values = {{"keys", keys}, {"channels", channels}, {"modes", kinds}};
    answer.sections = {
        {.id = "keys",
         .heading = "Keys of NAME.json",
         .tables = {{"keys",
                     "",
                     {{"section", "section"},
                      {"name", "key"},
                      {"unit", "unit"},
                      {"meaning", "meaning", "", "wrap"},
                      {"default", "where it is missing", "", "wrap"},
                      {"example", "example", "", "wrap"},
                      {"kinds", "kinds of bench", "", "wrap"}},
                     keys}}},
        {.id = "channels",
         .heading = "Columns of NAME.csv",
         .prose =
             "Beside run (the number of the run) and t (the time in the run, s). Other columns are kept, but no "
             "model knows them.",
         .tables =
             {{"channels", "", {{"name", "column"}, {"unit", "unit"}, {"meaning", "meaning"}}, channels}}},
        {.id = "modes",
         .heading = "Kinds of bench",
         .tables = {
             {"modes", "", {{"mode", "mode"}, {"driven", "driven by, where a run does not say"}}, kinds}}}};
    answer.csv_table = "keys";
    return answer;
}

}  // namespace capstan::answers
