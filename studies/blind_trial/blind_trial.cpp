#include "capstan/blind_trial/blind_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>

#include "capstan/cable/invalid_input.h"
#include "capstan/gap/equivalent_bench.h"
#include "capstan/platform/files.h"
#include "capstan/platform/parallel_for.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/json_object.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::gap_trial {

namespace {

using nlohmann::json;

// Calls `work` for each name that is not done.
void for_each_missing(const std::vector<std::string>& names, const std::string& activity, int jobs,
                      const BlindTrialHooks& hooks, const std::function<bool(const std::string&)>& is_done,
                      const std::function<void(const std::string&)>& work) {
    std::vector<std::string> missing;
    std::copy_if(names.begin(), names.end(), std::back_inserter(missing),
                 [&](const std::string& name) { return !is_done(name); });
    std::mutex reporting;
    int done = static_cast<int>(names.size() - missing.size());
    parallel_for_each_index(static_cast<int>(missing.size()), jobs, [&](int index) {
        work(missing[static_cast<std::size_t>(index)]);
        const std::lock_guard lock(reporting);
        hooks.on_progress(activity, ++done, static_cast<int>(names.size()));
    });
}

void write_reference(const std::filesystem::path& path,
                     const std::optional<std::vector<ChannelRms>>& channels) {
    json text = nullptr;
    if (channels) {
        text = json::array();
        for (const ChannelRms& each : *channels)
            text.push_back(
                {{"channel", each.channel}, {"rms_before", each.before}, {"rms_after", each.after}});
    }
    write_file(path, text.dump(1) + "\n");
}

Reference read_reference(const std::filesystem::path& path, const std::string& name) {
    const json text = read_json_file(path);
    Reference reference{name, std::nullopt};
    try {
        if (text.is_null()) return reference;
        reference.channels.emplace();
        for (const json& each : text)
            reference.channels->push_back({each.at("channel"), each.at("rms_before"), each.at("rms_after")});
    } catch (const json::exception& problem) {
        throw InvalidInput({fmt::format("{}: {}; remove the file, and the next run writes it again",
                                        path.string(), problem.what())});
    }
    return reference;
}

void diagnose_case(const TrialFolder& folder, const std::string& name, const std::string& seal) {
    gap::DiagnosisOptions one_thread;
    one_thread.threads = 1;
    const Recording recording = read_recording(folder.recording(name));
    const Recording bench = gap::equivalent_bench(recording, recording);
    write_answer(folder.answer(name), answer_of(name, gap::diagnose(bench, one_thread)), seal);
}

}  // namespace

TrialLabels make_recordings(const TrialOptions& options, const std::filesystem::path& folder, int jobs,
                            const CaseProgress& on_progress) {
    const bool is_rigs = options.kind == TrialKind::rigs;
    const std::vector<PlannedCase> plan = is_rigs ? plan_rigs(options) : plan_trial(options);
    TrialLabels labels{options, random_salt(), std::vector<CaseLabel>(plan.size())};
    std::mutex reporting;
    int done = 0;
    parallel_for_each_index(static_cast<int>(plan.size()), jobs, [&](int index) {
        const auto slot = static_cast<std::size_t>(index);
        labels.cases[slot] =
            is_rigs ? make_rig_case(plan[slot], options, folder) : make_case(plan[slot], options, folder);
        const std::lock_guard lock(reporting);
        on_progress("simulating", ++done, static_cast<int>(plan.size()));
    });
    return labels;
}

std::string prepare_trial(const TrialFolder& folder, const TrialOptions& options, int jobs,
                          const BlindTrialHooks& hooks) {
    std::string seal = folder.seal();
    if (seal.empty())
        seal = seal_labels(folder.path(), make_recordings(options, folder.path(), jobs, hooks.on_progress));
    hooks.on_sealed(seal);
    return seal;
}

void answer_trial(const TrialFolder& folder, const TrialOptions& options, const std::string& seal, int jobs,
                  const BlindTrialHooks& hooks) {
    std::vector<std::string> names;
    for (int k = 1; k <= options.cases; ++k) names.push_back(case_name(k));
    for_each_missing(
        names, "diagnosing", jobs, hooks,
        [&](const std::string& name) { return std::filesystem::exists(folder.answer(name)); },
        [&](const std::string& name) { diagnose_case(folder, name, seal); });
}

std::string answer_case(const TrialFolder& folder, int number) {
    const std::string name = case_name(number);
    if (folder.seal().empty() || !std::filesystem::exists(folder.recording(name)))
        throw InvalidInput(
            {fmt::format("{}: there is no sealed {}; `capstan gap-trial --keep {} --generate-only` "
                         "makes recordings and seals their labels",
                         folder.path().string(), name, folder.path().string())});
    if (!std::filesystem::exists(folder.answer(name))) diagnose_case(folder, name, folder.seal());
    return read_file(folder.answer(name));
}

TrialScore unseal_and_score(const TrialFolder& folder, const std::string& seal, int jobs,
                            const BlindTrialHooks& hooks) {
    const TrialLabels labels = unseal_labels(folder.labels(), seal);
    const std::string hash = folder.seal();
    std::vector<std::string> answered;
    for (const CaseLabel& label : labels.cases) {
        if (std::filesystem::exists(folder.answer(label.name))) answered.push_back(label.name);
    }
    const auto label_of = [&](const std::string& name) {
        return *std::find_if(labels.cases.begin(), labels.cases.end(),
                             [&](const CaseLabel& label) { return label.name == name; });
    };
    for_each_missing(
        answered, "fitting true causes", jobs, hooks,
        [&](const std::string& name) { return std::filesystem::exists(folder.reference(name)); },
        [&](const std::string& name) {
            write_reference(folder.reference(name),
                            reference_fit(read_recording(folder.recording(name)), label_of(name)));
        });
    std::vector<CaseAnswer> answers;
    std::vector<Reference> references;
    for (const std::string& name : answered) {
        answers.push_back(read_answer(folder.answer(name), hash));
        references.push_back(read_reference(folder.reference(name), name));
    }
    return score_trial(labels, answers, references);
}

}  // namespace capstan::gap_trial
