// Disks that are full, or may not be written. They are real file systems in memory; where the tests may not
// mount one, they are skipped.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>

#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

class SmallDisk {
  public:
    explicit SmallDisk(const std::string& size) {
        mounted_ = mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
        if (!mounted_) reason_ = std::string("cannot mount a small disk: ") + std::strerror(errno);
    }
    ~SmallDisk() {
        if (mounted_) umount2(folder_.path().c_str(), MNT_DETACH);
    }

    bool mounted() const { return mounted_; }
    const std::string& reason() const { return reason_; }
    std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

    [[nodiscard]] bool forbid_writing() {
        return mount("tmpfs", folder_.path().c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr) == 0;
    }

  private:
    TemporaryFolder folder_;
    bool mounted_ = false;
    std::string reason_;
};

const ExampleSize many_rows{.scenarios = 8, .noise_levels = 2, .sensor_sets = 20, .nodes = 11, .blocks = 40};

TEST(FullDisk, KeepsFinishedUnitsAndResumesWhenSpaceIsFree) {
    SmallDisk disk("2m");
    if (!disk.mounted()) GTEST_SKIP() << disk.reason();
    const std::string ballast(800 * 1024, 'x');
    std::ofstream(disk / "ballast", std::ios::binary) << ballast;

    std::size_t finished = 0;
    {
        Database database = Database::open_or_create(disk / "results.db");
        const auto study_id = begin_study(database, example_study(many_rows));
        const std::string message = error_of([&] {
            for (const int unit : pending_units(database, study_id)) {
                write_unit(database, study_id, unit, many_rows);
                ++finished;
            }
        });
        expect_says(message, "disk is full");
        expect_says(message, "capstan study resume");
        ASSERT_GT(finished, 0u);
        EXPECT_EQ(pending_units(database, study_id).size(), 32 - finished);
    }

    std::filesystem::remove(disk / "ballast");
    Database database = Database::open_existing(disk / "results.db");
    EXPECT_EQ(number_from(database, "SELECT integrity_check = 'ok' FROM pragma_integrity_check"), 1);
    const std::vector<int> pending = pending_units(database, 1);
    ASSERT_EQ(pending.size(), 32 - finished);
    EXPECT_EQ(read_single_sensor(database, 1, 0, 0), example_single_sensor(0, 0, many_rows).sensors);
    write_unit(database, 1, pending.front(), many_rows);
    EXPECT_EQ(pending_units(database, 1).size(), 31 - finished);
}

TEST(FullDisk, AFailedCreationIsReportedAndRepairedByTheNext) {
    SmallDisk disk("512k");
    if (!disk.mounted()) GTEST_SKIP() << disk.reason();
    std::ofstream(disk / "ballast", std::ios::binary) << std::string(400 * 1024, 'x');
    expect_says(error_of([&] { Database::open_or_create(disk / "results.db"); }), "disk is full");
    std::filesystem::remove(disk / "ballast");
    Database database = Database::open_or_create(disk / "results.db");
    EXPECT_TRUE(list_studies(database).empty());
}

TEST(ReadOnlyDisk, IsReadAndNotWritten) {
    SmallDisk disk("4m");
    if (!disk.mounted()) GTEST_SKIP() << disk.reason();
    {
        Database database = Database::open_or_create(disk / "50% #1?.db");
        begin_study(database, example_study());
    }
    if (!disk.forbid_writing()) GTEST_SKIP() << "cannot make the disk read-only";

    Database reader = Database::open_read_only(disk / "50% #1?.db");
    EXPECT_EQ(list_studies(reader).size(), 1u);
    EXPECT_EQ(run_read_only(reader, "SELECT * FROM study").rows.size(), 1u);
    expect_says(error_of([&] { Database::open_existing(disk / "50% #1?.db"); }), "may only be read");
    expect_says(error_of([&] { Database::open_or_create(disk / "new.db"); }), "write there");
}

TEST(ReadOnlyDisk, AnUnfinishedLogIsNotIgnored) {
    SmallDisk disk("4m");
    if (!disk.mounted()) GTEST_SKIP() << disk.reason();
    {
        Database writer = Database::open_or_create(disk / "results.db");
        begin_study(writer, example_study());
        // A killed writer leaves its log; the copy has the log and not yet the study.
        std::filesystem::copy_file(disk / "results.db", disk / "copy.db");
        std::filesystem::copy_file(disk / "results.db-wal", disk / "copy.db-wal");
    }
    if (!disk.forbid_writing()) GTEST_SKIP() << "cannot make the disk read-only";
    expect_says(error_of([&] { Database::open_read_only(disk / "copy.db"); }), "copy.db");
}

// Of a writer that was closed in order: the file alone is complete.
TEST(ReadOnlyDisk, AnEmptyLogIsNoLog) {
    SmallDisk disk("4m");
    if (!disk.mounted()) GTEST_SKIP() << disk.reason();
    {
        Database database = Database::open_or_create(disk / "results.db");
        begin_study(database, example_study());
    }
    { std::ofstream log(disk / "results.db-wal"); }
    if (!disk.forbid_writing()) GTEST_SKIP() << "cannot make the disk read-only";
    Database reader = Database::open_read_only(disk / "results.db");
    EXPECT_EQ(list_studies(reader).size(), 1u);
}

}  // namespace
}  // namespace capstan::storage
