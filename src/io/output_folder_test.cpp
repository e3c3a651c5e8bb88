#include "io/output_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "support/failing_files.h"
#include "support/folder_contents.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;
using test::in_a_process;
using test::kDied;
using test::kNever;
using test::names_in;
using test::put;
using test::TemporaryFolder;
using test::text_of;

using Names = std::set<std::string>;

constexpr const char* kOldManifest = R"({ "version": 1, "generator": "Lumel" })";

TEST(OutputFolder, AppearsOnlyWhenCommitted) {
    const TemporaryFolder folder;
    auto output = OutputFolder::create(folder / "a/b/out/");
    ASSERT_TRUE(output.ok()) << output.error().text();
    put(output->path() / "manifest.json", "new");
    EXPECT_FALSE(fs::exists(folder / "a/b/out"));
    ASSERT_TRUE(output->commit().ok());
    EXPECT_EQ(text_of(folder / "a/b/out/manifest.json"), "new");
    EXPECT_EQ(names_in(folder / "a/b"), Names{"out"});
}

TEST(OutputFolder, LeavesNothingWithoutCommit) {
    const TemporaryFolder folder;
    {
        auto output = OutputFolder::create(folder / "out");
        ASSERT_TRUE(output.ok());
        put(output->path() / "scene.glb", "half");
        const OutputFolder moved = std::move(output).value();
        EXPECT_EQ(folder.entries(), 1u);
    }
    EXPECT_EQ(folder.entries(), 0u);
}

TEST(OutputFolder, ReplacesOurFilesAndKeepsForeignOnes) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out");
    for (const char* name : {"manifest.json", "scene.glb", "lightmap_0.exr", "lightmap_7.exr", "preview_view_1.png"})
        put(folder / "out" / name, kOldManifest);
    for (const char* name : {"notes.txt", "lightmap_x.exr", "lightmap_.exr", "my_manifest.json"})
        put(folder / "out" / name, "foreign");
    auto output = OutputFolder::create(folder / "out");
    ASSERT_TRUE(output.ok());
    for (const char* name : {"manifest.json", "scene.glb", "lightmap_0.exr"}) put(output->path() / name, "new");
    ASSERT_TRUE(output->commit().ok());
    EXPECT_EQ(names_in(folder / "out"), (Names{"manifest.json", "scene.glb", "lightmap_0.exr", "notes.txt",
                                               "lightmap_x.exr", "lightmap_.exr", "my_manifest.json"}));
    EXPECT_EQ(text_of(folder / "out/scene.glb"), "new");
    EXPECT_EQ(text_of(folder / "out/notes.txt"), "foreign");
    EXPECT_EQ(folder.entries(), 1u);
}

// What was made of an older bake's files is not of the new one, and nothing in it would say so.
TEST(OutputFolder, EncodedFilesGoWithTheirBake) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out");
    for (const char* name : {"manifest.json", "encoded_l2.json", "encoded_l2_0.exr", "encoded_irradz-hhd_12.exr",
                             "encoded_l2_L0.ktx2", "encoded_l1-hhd_L1n-R_3.dds", "encoded_irradz-hhd_w-d_0.png",
                             "encoded_irradz-hhd_d.ktx2", "encoded_irradiance_I_0.hdr"})
        put(folder / "out" / name, kOldManifest);
    for (const char* name :
         {"encoded_l2_x.exr", "encoded_mine_0.exr", "encoded_l2_0.png", "encoded_l2_.exr", "encoded_l2_I.ktx2"})
        put(folder / "out" / name, "foreign");
    auto output = OutputFolder::create(folder / "out");
    ASSERT_TRUE(output.ok());
    put(output->path() / "manifest.json", "new");
    ASSERT_TRUE(output->commit().ok());
    EXPECT_EQ(names_in(folder / "out"), (Names{"manifest.json", "encoded_l2_x.exr", "encoded_mine_0.exr",
                                               "encoded_l2_0.png", "encoded_l2_.exr", "encoded_l2_I.ktx2"}));
}

// A folder of the name of one of our files cannot be replaced: everything must be as before.
TEST(OutputFolder, AFailureHalfWayPutsTheOldFilesBack) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "out/zzz");
    put(folder / "out/manifest.json", kOldManifest);
    put(folder / "out/scene.glb", "old");
    auto output = OutputFolder::create(folder / "out");
    ASSERT_TRUE(output.ok());
    for (const char* name : {"manifest.json", "scene.glb", "zzz"}) put(output->path() / name, "new");
    const Status status = output->commit();
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::io);
    EXPECT_EQ(names_in(folder / "out"), (Names{"manifest.json", "scene.glb", "zzz"}));
    EXPECT_EQ(text_of(folder / "out/manifest.json"), kOldManifest);
    EXPECT_EQ(text_of(folder / "out/scene.glb"), "old");
}

TEST(OutputFolder, FilesOfOurNamesThatNoBakeWroteAreNotReplaced) {
    for (const char* name : {"scene.glb", "report.json", "manifest.json"}) {
        const TemporaryFolder folder;
        fs::create_directory(folder / "out");
        put(folder / "out" / name, R"({ "name": "a web page" })");
        const auto output = OutputFolder::create(folder / "out");
        ASSERT_FALSE(output.ok()) << name;
        EXPECT_NE(output.error().text().find(name), std::string::npos) << output.error().text();
        EXPECT_EQ(names_in(folder / "out"), Names{name});
        EXPECT_EQ(folder.entries(), 1u);
    }
    EXPECT_FALSE(OutputFolder::create("").ok());
}

TEST(OutputFolder, AFileInThePlaceOfTheFolderIsAnErrorAtOnce) {
    const TemporaryFolder folder;
    put(folder / "out", "a file");
    const auto output = OutputFolder::create(folder / "out");
    ASSERT_FALSE(output.ok());
    EXPECT_NE(output.error().text().find("not a folder"), std::string::npos);
    EXPECT_FALSE(OutputFolder::create(folder / "out/below").ok());
    EXPECT_FALSE(OutputFolder::create("/").ok());
    EXPECT_FALSE(OutputFolder::create("/proc/lumel-out").ok());
    EXPECT_EQ(folder.entries(), 1u);
}

// Whatever the number says: in containers it is that of a living process again.
TEST(OutputFolder, WhatAKilledProcessLeftIsRemoved) {
    const TemporaryFolder folder;
    for (const long process : {2000000000L, long{::getppid()}, long{::getpid()}, 1L})
        fs::create_directory(folder / ("out.partial-" + std::to_string(process)));
    fs::create_directory(folder / "out.partial-mine");
    auto output = OutputFolder::create(folder / "out");
    ASSERT_TRUE(output.ok());
    ASSERT_TRUE(output->commit().ok());
    EXPECT_EQ(names_in(folder.path()), (Names{"out", "out.partial-mine"}));
}

TEST(OutputFolder, WhatALivingOneWritesStays) {
    const TemporaryFolder folder;
    auto first = OutputFolder::create(folder / "out");
    ASSERT_TRUE(first.ok());
    put(first->path() / "manifest.json", kOldManifest);
    auto second = OutputFolder::create(folder / "out");
    ASSERT_TRUE(second.ok());
    EXPECT_NE(first->path(), second->path());
    ASSERT_TRUE(first->commit().ok());
    EXPECT_EQ(text_of(folder / "out/manifest.json"), kOldManifest);
    put(second->path() / "manifest.json", "second");
    ASSERT_TRUE(second->commit().ok());
    EXPECT_EQ(text_of(folder / "out/manifest.json"), "second");
    EXPECT_EQ(folder.entries(), 1u);
}

const Names kOldNames{"manifest.json", "scene.glb", "lightmap_0.exr", "lightmap_1.exr"};
const Names kNewNames{"manifest.json", "scene.glb", "lightmap_0.exr", "preview_view_0.png"};
constexpr const char* kNewManifest = R"({ "version": 1, "generator": "Lumel", "new": true })";

// Bakes over an older bake, stopped after so many steps of commit().
bool replace(const fs::path& out, int steps, bool fails) {
    fs::create_directory(out);
    for (const std::string& name : kOldNames) put(out / name, kOldManifest);
    put(out / "notes.txt", "foreign");
    return in_a_process(kNever, false, [&] {
        auto output = OutputFolder::create(out);
        if (!output.ok()) ::_exit(1);
        for (const std::string& name : kNewNames) put(output->path() / name, kNewManifest);
        test::steps_left = steps;
        test::fails_then = fails;
        (void)output->commit();
        ::_exit(test::steps_left < 0 || (test::steps_left == 0 && fails) ? kDied : 0);
    });
}

void expect_whole(const TemporaryFolder& folder, bool newer, const std::string& what) {
    Names expected = newer ? kNewNames : kOldNames;
    for (const std::string& name : expected)
        EXPECT_EQ(text_of(folder / "out" / name), newer ? kNewManifest : kOldManifest) << what << " " << name;
    expected.insert("notes.txt");
    EXPECT_EQ(names_in(folder / "out"), expected) << what;
    EXPECT_EQ(folder.entries(), 1u) << what;
}

// A bake that is stopped after any number of steps of its commit(), and the next one after any number of steps of
// putting that right: the one after finds the older bake or the newer, whole, with the user's own files, and nothing
// beside it. Stopped: killed, or no file can be moved any more.
TEST(OutputFolder, ABakeStoppedWhileItReplacesIsPutRight) {
    for (const bool fails : {false, true}) {
        int steps = 0, stopped_recoveries = 0;
        for (bool committed = false; !committed; ++steps) {
            bool recovered = false;
            for (int recovery = 0; !recovered; ++recovery) {
                const TemporaryFolder folder;
                committed = replace(folder / "out", steps, fails);
                const bool newer = text_of(folder / "out/manifest.json") == kNewManifest;
                const auto recover = [&] { (void)OutputFolder::create(folder / "out"); };
                recovered = in_a_process(recovery, fails, recover);
                stopped_recoveries += recovered ? 0 : 1;
                const std::string what = std::to_string(steps) + ", then " + std::to_string(recovery) + " steps";
                {
                    const auto next = OutputFolder::create(folder / "out");
                    ASSERT_TRUE(next.ok()) << what << ": " << next.error().text();
                }
                expect_whole(folder, newer, what);
                ASSERT_LT(recovery, 100) << "steps are not seen";
            }
            ASSERT_LT(steps, 100) << "steps are not seen";
        }
        EXPECT_GT(steps, 9) << "there are nine moves";
        EXPECT_GT(stopped_recoveries, 30) << "steps are not seen";
    }
}

// What is put back overwrites nothing: a file that the user made since stays, and so does the old one beside it.
TEST(OutputFolder, PuttingBackKeepsWhatIsThere) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out");
    fs::create_directory(folder / "out.leaving-2000000000");
    put(folder / "out/notes.txt", "mine");
    put(folder / "out.leaving-2000000000/notes.txt", "older");
    put(folder / "out.leaving-2000000000/scene.glb", "old");
    put(folder / "out.leaving-2000000000/manifest.json", kOldManifest);
    ASSERT_TRUE(OutputFolder::create(folder / "out").ok());
    EXPECT_EQ(text_of(folder / "out/notes.txt"), "mine");
    EXPECT_EQ(text_of(folder / "out/scene.glb"), "old");
    EXPECT_EQ(text_of(folder / "out.leaving-2000000000/notes.txt"), "older");
}

TEST(OutputFolder, ErrorsNameThePlaceThatTheUserAskedFor) {
    const TemporaryFolder folder;
    const auto output = OutputFolder::create(folder / "out");
    ASSERT_TRUE(output.ok());
    const Error error{ErrorCode::io, "writing failed", (output->path() / "lightmap_0.exr").string(), {}};
    EXPECT_EQ(output->as_in_target(error).where, (fs::canonical(folder.path()) / "out/lightmap_0.exr").string());
    const Error other{ErrorCode::io, "reading failed", "sky.hdr", {}};
    EXPECT_EQ(output->as_in_target(other).where, "sky.hdr");
}

TEST(OutputFolder, FollowsALinkToItsPlace) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "far/real");
    fs::create_directory_symlink(folder / "far/real", folder / "link");
    auto output = OutputFolder::create(folder / "link");
    ASSERT_TRUE(output.ok());
    EXPECT_EQ(output->path().parent_path().filename(), "far");
    put(output->path() / "scene.glb", "new");
    ASSERT_TRUE(output->commit().ok());
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(text_of(folder / "far/real/scene.glb"), "new");
}

}  // namespace
}  // namespace lumel
