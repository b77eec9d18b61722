#include <gtest/gtest.h>

#include "capstan/blind_trial/blind_trial.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/recording/recording_reader.h"
#include "scratch_folder.h"

namespace capstan::gap_trial {
namespace {

TrialOptions short_trial() {
    TrialOptions options;
    options.cases = 3;
    options.seed = 11;
    options.length = RecordingLength::brief;
    options.nominal_error = 0.01;
    return options;
}

std::string without_salt(TrialLabels labels) {
    labels.salt.clear();
    return labels_text(labels);
}

class TrialRecordings : public testing::TestWithParam<TrialKind> {};

TEST_P(TrialRecordings, AreTheSameBitsForAnyNumberOfThreads) {
    TrialOptions options = short_trial();
    options.kind = GetParam();
    const ScratchFolder one;
    const ScratchFolder three;
    const auto quiet = [](const std::string&, int, int) {};
    const TrialLabels labels = make_recordings(options, one.path(), 1, quiet);
    const TrialLabels again = make_recordings(options, three.path(), 3, quiet);
    EXPECT_EQ(without_salt(labels), without_salt(again));
    ASSERT_EQ(labels.cases.size(), 3U);
    for (const CaseLabel& label : labels.cases) {
        for (const std::string& name : {label.name + ".csv", label.name + ".json"}) {
            const std::string bytes = bytes_of(one.path() / name);
            EXPECT_GT(bytes.size(), 100U);
            EXPECT_EQ(bytes, bytes_of(three.path() / name)) << name;
        }
        // The lab's own reader takes them, and they tell nothing of what is behind.
        const Recording recording = read_recording(one.path() / (label.name + ".csv"));
        EXPECT_EQ(recording.runs.size(), label.protocols.size());
        EXPECT_EQ(recording.runs.front().conditions.size(), label.conditions.size());
        const std::string sidecar = bytes_of(one.path() / (label.name + ".json"));
        for (const char* word :
             {"effect", "cause", "severity", "visibility", "true_ratios", "nuisance", "varies"})
            EXPECT_EQ(sidecar.find(word), std::string::npos) << word;
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, TrialRecordings, testing::Values(TrialKind::benches, TrialKind::rigs),
                         [](const auto& kind) { return trial_kind_name(kind.param); });

TEST(TrialFolder, RejectsTheFolderOfAnotherTrial) {
    const ScratchFolder scratch;
    TrialOptions options = short_trial();
    { const TrialFolder folder = TrialFolder::kept(scratch.path() / "t", options); }
    EXPECT_NO_THROW(TrialFolder::kept(scratch.path() / "t", options));
    ++options.seed;
    EXPECT_THROW(TrialFolder::kept(scratch.path() / "t", options), InvalidInput);
}

TEST(TrialFolder, ATemporaryFolderIsRemoved) {
    std::filesystem::path path;
    {
        const TrialFolder folder = TrialFolder::temporary(short_trial());
        path = folder.path();
        EXPECT_TRUE(std::filesystem::exists(path / "trial.json"));
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace capstan::gap_trial
