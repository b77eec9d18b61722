// What goes into the digest of a row, and which digest it is: a file has to be found intact by later
// versions.

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/integrity/row_digest.h"
#include "capstan/storage/integrity/verification.h"
#include "capstan/storage/integrity/world_hash.h"
#include "capstan/storage/statement.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

template <class... Values>
std::string digest_of(const Values&... values) {
    RowDigest digest;
    (digest.add("column", values), ...);
    digest.end_row();
    return hexadecimal(digest.finish());
}

// By hand: length and name of the column, its type, the value, and a length of 0 for the end of the row.
TEST(Digest, IsTheSha256OfNameTypeAndBits) {
    EXPECT_EQ(digest_of(std::int64_t{258}),
              "bb1b0465f1977808dc92b8155a84a594ea1f070b416629fae725ef010e93a78b");
    EXPECT_EQ(digest_of(1.5), "2a8ee72f128168bcb9da3d9b4284043872b7d8a5844064960457a7099e407bdb");
    EXPECT_EQ(digest_of(std::string_view("ab")),
              "3643afe2801da9cdf488ca272c8b35453aaae15423f9795ada34ab373697d0fa");
    EXPECT_EQ(digest_of(), "df3f619804a92fdb4057192dc43dd748ea778adc52bc498ce80524c014b81119");
}

TEST(Digest, TellsTheZerosOfBothSignsNotApart) {
    EXPECT_EQ(digest_of(-0.0), digest_of(0.0));
    EXPECT_NE(digest_of(std::numeric_limits<double>::denorm_min()), digest_of(0.0));
}

TEST(Digest, TellsTheEndsOfTextsAndRowsApart) {
    EXPECT_NE(digest_of(std::string_view("ab"), std::string_view("c")),
              digest_of(std::string_view("a"), std::string_view("bc")));
    RowDigest digest;
    EXPECT_FALSE(digest.has_rows());
    digest.add("column", 1.0);
    digest.end_row();
    EXPECT_TRUE(digest.has_rows());
    digest.add("column", 2.0);
    digest.end_row();
    EXPECT_NE(hexadecimal(digest.finish()), digest_of(1.0, 2.0));
    EXPECT_FALSE(digest.has_rows());
}

// One text is longer than the digest's buffer, the others fill it in portions.
TEST(Digest, DoesNotDependOnHowTheBytesAreBuffered) {
    const std::string many(40'000, 'x');
    EXPECT_EQ(digest_of(std::string_view(many)),
              "8d8ddfbcfa2a8a9f6b0959162bfff6e1e44edaa99bfd7545b953111da13bb70c");
    RowDigest digest;
    for (int row = 0; row < 3000; ++row) {
        digest.add("column", std::int64_t{row});
        digest.end_row();
    }
    EXPECT_EQ(hexadecimal(digest.finish()),
              "bd90e775af64af52ada5495ddd22b74c47b9b8a76af06b690e1ec4c9e60b604e");
}

TEST(Digest, OfWorldsIsASumWithCarriesThatDropsTheLast) {
    Sha256 one{};
    one[0] = 1;
    const std::string nothing(64, '0');
    EXPECT_EQ(sum_of("", one), "01" + nothing.substr(2));
    EXPECT_EQ(sum_of("ff" + nothing.substr(2), one), "0001" + nothing.substr(4));
    EXPECT_EQ(sum_of("ffff" + nothing.substr(4), one), "000001" + nothing.substr(6));
    EXPECT_EQ(sum_of(std::string(64, 'f'), one), nothing);
}

class Hashes : public testing::Test {
  protected:
    std::string hash_of(const std::string& part, int index, const std::string& table) {
        Statement select(database,
                         "SELECT sha256 FROM content_hash WHERE part = ?1 AND part_index = ?2 AND "
                         "table_name = ?3");
        select.bind_all(std::string_view(part), index, std::string_view(table));
        return select.step() ? select.get<std::string>(0) : "none";
    }
    TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
};

// Stored numbers: files that exist hold such hashes. A change that needs others has to say what becomes of
// those files.
TEST_F(Hashes, OfTheExampleStudyStayAsTheyAre) {
    begin_study(database, example_study());
    EXPECT_EQ(hash_of("description", 0, "scenario_node"),
              "c71687608d096268597cf61f2183e058440c4f426dd304527df4cd7e533ee057");
    for (const int unit : pending_units(database, 1)) write_unit(database, 1, unit);
    EXPECT_EQ(hash_of("unit", 3, "cell"), "a9d4a33da3a641dba24671a948e29b04f5cbcaebf96ef5b202c522334b196954");
    finish_study(database, 1, example_recommendations(), example_paper_comparison());
    EXPECT_EQ(hash_of("conclusions", 0, "recommendation"),
              "7066affeea78440878dc56c5c6e9509c43b9fe401d5f7b4f7f4f18a619e5c7fb");
}

TEST_F(Hashes, HaveATableOfThemForEveryTableWithRowsAndForNoOther) {
    begin_study(database, example_study());
    EXPECT_EQ(hash_of("description", 0, "world_candidate"), "none");
    EXPECT_EQ(number_from(database, "SELECT count(*) FROM content_hash WHERE part = 'description'"), 10);
}

TEST_F(Hashes, OfADiagnosisNoticeAChangeALossAndAnAddition) {
    DiagnosisRecord diagnosis;
    diagnosis.runs = "[1]";
    diagnosis.effects = {{"creep", 0.9, 0.95, ""}, {"none", 0.1, {}, ""}};
    write_diagnosis(database, diagnosis);
    const HashCheck intact = check_hashes(database);
    EXPECT_TRUE(intact.problems.empty());
    EXPECT_TRUE(intact.unhashed.empty());
    EXPECT_EQ(intact.hashed, 1);
    database.execute("UPDATE diagnosis_effect SET probability_fraction = 0.2 WHERE place = 2", "damage");
    EXPECT_EQ(check_hashes(database).problems,
              std::vector<std::string>{"diagnosis 1: table diagnosis_effect is not as it was written"});
    database.execute("DELETE FROM diagnosis_effect", "damage");
    EXPECT_EQ(check_hashes(database).problems,
              std::vector<std::string>{"diagnosis 1: table diagnosis_effect is not as it was written"});
    database.execute("DELETE FROM diagnosis_hash WHERE table_name = 'diagnosis'", "damage");
    expect_says(check_hashes(database).problems.back(),
                "diagnosis 1 has rows in table diagnosis, but no hash");
}

TEST_F(Hashes, NameWhatIsMissingAndWhichHashItIs) {
    begin_study(database, example_study());
    for (const int unit : pending_units(database, 1)) write_unit(database, 1, unit);
    finish_study(database, 1, example_recommendations(), example_paper_comparison());
    database.execute("UPDATE content_hash SET sha256 = replace(sha256, '0', '1') WHERE part = 'study'",
                     "damage");
    EXPECT_EQ(check_hashes(database).problems,
              std::vector<std::string>{
                  "study 1 (example), hash over all hashes: table content_hash is not as it was written"});
    database.execute(
        "DELETE FROM content_hash WHERE part = 'unit' AND part_index = 3 AND table_name = 'cell'", "damage");
    expect_says(check_hashes(database).problems.front(),
                "study 1 (example), unit 3 (stage fusion, instant 0, noise 'level 1')");
    expect_says(check_hashes(database).problems.front(), ") has rows in table cell, but no hash of them");
    database.execute("DELETE FROM paper_comparison", "damage");
    expect_says(check_hashes(database).problems.at(1),
                "study 1 (example), conclusions has lost its rows in table paper_comparison");
    database.execute("UPDATE work_unit SET done = 0 WHERE unit_index = 2", "damage");
    expect_says(check_hashes(database).problems.back(), "is gone, and its hash is still there");
}

// Ten rows go into one statement, and the rest one by one: all are hashed as they are stored.
TEST_F(Hashes, OfRowsWrittenInPortionsAreThoseOfTheStoredRows) {
    const ExampleSize size{.scenarios = 1, .noise_levels = 1, .sensor_sets = 2, .nodes = 13, .blocks = 23};
    begin_study(database, example_study());
    const std::int64_t study_id = begin_study(database, example_study(size));
    for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit, size);
    const HashCheck check = check_hashes(database);
    EXPECT_EQ(check.problems, std::vector<std::string>{});
    EXPECT_EQ(check.hashed, 4);  // two descriptions, two units
}

TEST_F(Hashes, AreNeededByNoUnitThatStoresNothing) {
    StudyDescription description = example_study();
    description.fusion_methods.clear();
    begin_study(database, description);
    write_fusion(database, 1, 1, {0, 0, {}, {}, {}});
    EXPECT_EQ(check_hashes(database).problems, std::vector<std::string>{});
}

TEST_F(Hashes, OfManyProblemsNameTwenty) {
    begin_study(
        database,
        example_study({.scenarios = 5, .noise_levels = 3, .sensor_sets = 1, .nodes = 2, .blocks = 1}));
    database.execute("UPDATE work_unit SET done = 1", "call all units done");
    database.execute(
        "INSERT INTO content_hash SELECT 1, 'unit', unit_index, 'cell', hex(zeroblob(32)) FROM work_unit",
        "name hashes of nothing");
    EXPECT_EQ(check_hashes(database).problems.size(), 20u);
    delete_study(database, 1);
    DiagnosisRecord diagnosis;
    diagnosis.runs = "[1]";
    for (int k = 0; k < 25; ++k) write_diagnosis(database, diagnosis);
    database.execute("UPDATE diagnosis SET worst_run = 7", "damage");
    EXPECT_EQ(check_hashes(database).problems.size(), 20u);
    database.execute("UPDATE diagnosis_hash SET table_name = 'diagnosis_gap'", "damage");
    EXPECT_EQ(check_hashes(database).problems.size(), 20u);
}

}  // namespace
}  // namespace capstan::storage
