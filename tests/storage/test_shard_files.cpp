// The file of a shard says which it is, and may lie where several machines see it.
#include <gtest/gtest.h>

#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

TEST(ShardFile, SaysWhichShardItIs) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "shard.db", Journal::rollback);
        EXPECT_FALSE(read_shard(database));
        const auto ids = begin_shard(database, {2, 5}, {example_study(), example_study()});
        EXPECT_EQ(ids, (std::vector<std::int64_t>{1, 2}));
    }
    Database database = Database::open_read_only(folder / "shard.db");
    EXPECT_EQ(read_shard(database), (ShardRecord{2, 5}));
    EXPECT_EQ(list_studies(database).size(), 2u);
}

TEST(ShardFile, HoldsTheSameStudiesAsACompleteFile) {
    const TemporaryFolder folder;
    Database shard = Database::open_or_create(folder / "shard.db", Journal::rollback);
    Database complete = Database::open_or_create(folder / "complete.db");
    begin_shard(shard, {1, 2}, {example_study(), example_study()});
    for (const std::int64_t id : {1, 2}) {
        EXPECT_EQ(begin_study(complete, example_study()), id);
        EXPECT_EQ(load_study(shard, id), load_study(complete, id));
    }
}

TEST(ShardFile, CannotReplaceAFileWithStudies) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    begin_study(database, example_study());
    EXPECT_FALSE(begin_shard(database, {1, 2}, {example_study()}).has_value());
    EXPECT_FALSE(read_shard(database));
    EXPECT_EQ(list_studies(database).size(), 1u);
}

TEST(ShardFile, IsCreatedCompletelyOrNotAtAll) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "shard.db", Journal::rollback);
    StudyDescription broken = example_study();
    broken.layouts.front().set_index = 99;
    EXPECT_THROW(begin_shard(database, {1, 2}, {example_study(), broken}), Error);
    EXPECT_FALSE(read_shard(database));
    EXPECT_TRUE(list_studies(database).empty());
    EXPECT_THROW(begin_shard(database, {3, 2}, {example_study()}), Error);
    EXPECT_TRUE(list_studies(database).empty());
}

// A write-ahead log needs memory that only one machine sees.
TEST(ShardFile, LeavesNoWriteAheadLog) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "shard.db", Journal::rollback);
    begin_shard(database, {1, 2}, {example_study()});
    write_unit(database, 1, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "shard.db-wal"));
    EXPECT_FALSE(std::filesystem::exists(folder / "shard.db-shm"));
}

// Killed in the middle of a transaction that had begun to write into the file: who may only read must not
// take what is there for the truth, and the next writer rolls it back.
TEST(ShardFile, AnInterruptedTransactionIsRolledBackNotRead) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "shard.db", Journal::rollback);
        begin_shard(database, {1, 2}, {example_study()});
        database.execute("PRAGMA cache_size = 1; PRAGMA cache_spill = 1; BEGIN IMMEDIATE", "test");
        for (int k = 0; k < 200; ++k) {
            database.execute(
                "INSERT INTO study SELECT max(study_id) + 1, hex(randomblob(4000)), '', '', 0, 1, 1, "
                "'running' FROM study",
                "test");
        }
        for (const char* end : {"", "-journal"}) {
            std::filesystem::copy_file((folder / "shard.db").string() + end,
                                       (folder / "killed.db").string() + end);
        }
    }
    ASSERT_GT(std::filesystem::file_size(folder / "killed.db-journal"), 0u);
    Database database = Database::open_or_create(folder / "killed.db", Journal::rollback);
    EXPECT_EQ(list_studies(database).size(), 1u);
}

// A worker that comes later, or comes again, goes on with the studies of its shard and of no other.
TEST(ShardFile, IsFoundAgainByItsNumberOnly) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "shard.db", Journal::rollback);
    const std::vector<StudyDescription> studies{example_study(), example_study()};
    EXPECT_EQ(begin_or_find_shard(database, {2, 5}, studies), (std::vector<std::int64_t>{1, 2}));
    EXPECT_EQ(begin_or_find_shard(database, {2, 5}, studies), (std::vector<std::int64_t>{1, 2}));
    EXPECT_EQ(list_studies(database).size(), 2u);
    expect_says(error_of([&] {
                    begin_or_find_shard(database, {3, 5}, studies);
                }),
                "is shard 2 of 5, not shard 3 of 5");
    expect_says(error_of([&] {
                    begin_or_find_shard(database, {2, 6}, studies);
                }),
                "is shard 2 of 5, not shard 2 of 6");
    Database complete = Database::open_or_create(folder / "complete.db");
    begin_study(complete, example_study());
    expect_says(error_of([&] { begin_or_find_shard(complete, {2, 5}, studies); }), "holds complete studies");
}

}  // namespace
}  // namespace capstan::storage
