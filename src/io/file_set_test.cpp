#include "io/file_set.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "io/output_folder.h"
#include "io/page_files.h"
#include "support/failing_files.h"
#include "support/folder_contents.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;
using test::in_a_process;
using test::names_in;
using test::put;
using test::TemporaryFolder;
using test::text_of;

FileSetKind tiles() {
    return {"set of tiles", "tiles", "\"Tiler\"",
            [](const std::string& name) { return is_numbered(name, "tile_", ".png"); }};
}

const std::string kOld = R"({ "generator": "Tiler" })", kNew = R"({ "generator": "Tiler", "new": true })";
const Names kOldNames{"tiles.json", "tile_0.png", "tile_7.png"}, kNewNames{"tiles.json", "tile_0.png", "tile_1.png"};

void put_old(const fs::path& folder) {
    fs::create_directories(folder);
    for (const std::string& name : kOldNames) put(folder / name, kOld);
    put(folder / "notes.txt", "foreign");
}

Result<FileSet> with_new_files(const fs::path& folder) {
    Result<FileSet> set = FileSet::create(folder, tiles());
    EXPECT_TRUE(set.ok()) << (set.ok() ? "" : set.error().text());
    if (set.ok())
        for (const std::string& name : kNewNames) put(set->partial() / name, kNew);
    return set;
}

void expect_whole(const fs::path& folder, bool newer, const std::string& what = {}) {
    Names expected = newer ? kNewNames : kOldNames;
    for (const std::string& name : expected) EXPECT_EQ(text_of(folder / name), newer ? kNew : kOld) << what << name;
    expected.insert("notes.txt");
    EXPECT_EQ(names_in(folder), expected) << what;
}

TEST(FileSet, ReplacesAnOlderSetAndNothingElse) {
    const TemporaryFolder folder;
    put_old(folder.path());
    {
        auto set = with_new_files(folder.path());
        ASSERT_TRUE(set.ok());
        ASSERT_TRUE(set->commit().ok());
    }
    expect_whole(folder.path(), true);
}

TEST(FileSet, WhatWasMadeForNothingGoes) {
    const TemporaryFolder folder;
    { ASSERT_TRUE(with_new_files(folder / "a").ok()); }
    EXPECT_EQ(folder.entries(), 0u);
    put_old(folder / "old");
    { ASSERT_TRUE(with_new_files(folder / "old").ok()); }
    expect_whole(folder / "old", false);
}

// A process that ends itself runs no destructors.
TEST(FileSet, TheCleanerRemovesTheFolderOnlyIfItWasMade) {
    const TemporaryFolder folder;
    auto made = with_new_files(folder / "made");
    ASSERT_TRUE(made.ok());
    made->cleaner()();
    EXPECT_FALSE(fs::exists(folder / "made"));
    put_old(folder / "old");
    auto older = with_new_files(folder / "old");
    ASSERT_TRUE(older.ok());
    older->cleaner()();
    expect_whole(folder / "old", false);
    fs::create_directory(folder / "empty");
    auto empty = with_new_files(folder / "empty");
    ASSERT_TRUE(empty.ok());
    empty->cleaner()();
    EXPECT_EQ(names_in(folder / "empty"), Names{});
}

// A folder of the name of one of the files: all is as it was.
TEST(FileSet, AFolderInTheWayStopsAllOfIt) {
    const TemporaryFolder folder;
    put_old(folder.path());
    fs::create_directory(folder / "tile_1.png");
    {
        auto set = with_new_files(folder.path());
        ASSERT_TRUE(set.ok());
        const Status status = set->commit();
        ASSERT_FALSE(status.ok());
        EXPECT_EQ(status.error().code, ErrorCode::io);
        EXPECT_EQ(status.error().where, (folder / "tile_1.png").string());
    }
    fs::remove(folder / "tile_1.png");
    expect_whole(folder.path(), false);
}

// Stopped, by death or by a disk that fails, after any number of steps of commit(): the next one finds the older set or
// the newer, whole, and leaves nothing else.
TEST(FileSet, OneStoppedWhileItReplacesIsPutRight) {
    for (const bool fails : {false, true}) {
        int steps = 0;
        for (bool committed = false; !committed; ++steps) {
            const TemporaryFolder folder;
            put_old(folder.path());
            committed = in_a_process(test::kNever, false, [&] {
                auto set = with_new_files(folder.path());
                if (!set.ok()) ::_exit(1);
                test::steps_left = steps;
                test::fails_then = fails;
                (void)set->commit();
                ::_exit(test::steps_left < 0 || (test::steps_left == 0 && fails) ? test::kDied : 0);
            });
            const bool newer = text_of(folder / "tiles.json") == kNew;
            const std::string what = std::to_string(steps) + " steps ";
            {
                const auto next = FileSet::create(folder.path(), tiles());
                ASSERT_TRUE(next.ok()) << what << next.error().text();
            }
            expect_whole(folder.path(), newer, what);
            ASSERT_LT(steps, 100) << "steps are not seen";
        }
        EXPECT_GT(steps, 7) << "there are seven moves";
    }
}

// A name is no proof: only with a JSON of ours are they of an older set.
TEST(FileSet, FilesOfItsNamesThatItDidNotWriteAreNotReplaced) {
    for (const char* name : {"tiles.json", "tile_7.png"}) {
        const TemporaryFolder folder;
        put(folder / name, "{\"generator\": \"somebody\"}");
        const auto set = FileSet::create(folder.path(), tiles());
        ASSERT_FALSE(set.ok()) << name;
        EXPECT_EQ(set.error().code, ErrorCode::io);
        EXPECT_EQ(set.error().where, (folder / name).string());
        EXPECT_EQ(names_in(folder.path()), Names{name});
    }
}

// What is called like the set but is none of it has no say, and is not touched.
TEST(FileSet, NamesLikeItsOwnAreNothingToIt) {
    const TemporaryFolder folder;
    put(folder / "tiles", "a file");
    fs::create_directory(folder / "tiles.partial-1");
    fs::create_directory(folder / "tiles.leaving-1");
    put(folder / "tiles.leaving-1/scene.glb", "somebody's");
    const Names before = names_in(folder.path());
    { ASSERT_TRUE(with_new_files(folder.path()).ok()); }
    EXPECT_EQ(names_in(folder.path()), before);
    EXPECT_TRUE(fs::exists(folder / "tiles.leaving-1/scene.glb"));
    const auto in_a_file = FileSet::create(folder / "tiles", tiles());
    ASSERT_FALSE(in_a_file.ok());
    EXPECT_EQ(in_a_file.error().message, "is not a folder");
}

// What a killed process left goes with the next set, of any kind, and with the next bake; what a living one writes
// stays.
TEST(FileSet, WhatAKilledProcessLeftIsRemoved) {
    const TemporaryFolder folder;
    const auto leave = [&](const std::string& stem) {
        fs::create_directory(folder / ("out/.lumel-" + stem));
        put(folder / ("out/.lumel-" + stem) / "page", "half");
    };
    fs::create_directory(folder / "out");
    leave("encoded_l2.partial-1");
    leave("tiles.partial-2000000000");
    leave("mine");
    {
        const auto living = FileSet::create(folder / "out", tiles());
        ASSERT_TRUE(living.ok());
        EXPECT_EQ(names_in(folder / "out"), (Names{living->partial().filename(), ".lumel-mine"}));
        const auto another = FileSet::create(folder / "out", tiles());
        ASSERT_TRUE(another.ok());
        EXPECT_TRUE(fs::exists(living->partial()));
        EXPECT_NE(another->partial(), living->partial());

        leave("encoded_l2.partial-1");
        leave("encoded_l2.leaving-1");  // of the bake that is replaced
        auto bake = OutputFolder::create(folder / "out");
        ASSERT_TRUE(bake.ok());
        put(bake->path() / "manifest.json", "\"Lumel\"");
        ASSERT_TRUE(bake->commit().ok());
        EXPECT_EQ(names_in(folder / "out"),
                  (Names{living->partial().filename(), another->partial().filename(), ".lumel-mine", "manifest.json"}));
    }
    EXPECT_EQ(names_in(folder / "out"), (Names{".lumel-mine", "manifest.json"}));
}

}  // namespace
}  // namespace lumel
