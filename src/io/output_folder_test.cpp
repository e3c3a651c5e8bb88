#include "io/output_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <set>
#include <vector>

#include "support/temporary_folder.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

std::string text_of(const fs::path& path) {
    std::string text;
    std::getline(std::ifstream(path), text, '\0');
    return text;
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> out;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) out.insert(entry.path().filename());
    return out;
}

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

TEST(OutputFolder, WhatAKilledProcessLeftIsRemoved) {
    const TemporaryFolder folder;
    // Process ids end far below this.
    fs::create_directory(folder / "out.partial-2000000000");
    fs::create_directory(folder / "out.partial-mine");
    // The parent process is alive: its folder stays.
    const std::string alive = "out.partial-" + std::to_string(::getppid());
    fs::create_directory(folder / alive);
    auto output = OutputFolder::create(folder / "out");
    ASSERT_TRUE(output.ok());
    ASSERT_TRUE(output->commit().ok());
    EXPECT_EQ(names_in(folder.path()), (Names{"out", "out.partial-mine", alive}));
}

// A bake that is killed after any number of its moves: the next one finds the older bake or the newer, whole, with the
// user's own files, and nothing beside it. The moves are those of commit(), made here one by one.
TEST(OutputFolder, ABakeKilledWhileItReplacesIsPutRight) {
    const Names old_names{"manifest.json", "scene.glb", "lightmap_0.exr", "lightmap_1.exr"};
    const Names new_names{"manifest.json", "scene.glb", "lightmap_0.exr", "preview_view_0.png"};
    const std::string process = "-2000000000";  // process ids end far below this
    std::vector<std::array<std::string, 2>> moves;
    const auto leave = [&](const std::string& name) {
        moves.push_back({"out/" + name, "out.leaving" + process + "/" + name});
    };
    const auto enter = [&](const std::string& name) {
        moves.push_back({"out.partial" + process + "/" + name, "out/" + name});
    };
    leave("manifest.json");
    for (const std::string& name : old_names)
        if (name != "manifest.json") leave(name);
    moves.push_back({"out.leaving" + process, "out.replaced" + process});
    for (const std::string& name : new_names)
        if (name != "manifest.json") enter(name);
    enter("manifest.json");

    for (std::size_t done = 0; done <= moves.size(); ++done) {
        const TemporaryFolder folder;
        for (const char* name : {"out", "out.leaving", "out.partial"})
            fs::create_directory(folder / (name + (std::string(name) == "out" ? "" : process)));
        for (const std::string& name : old_names) put(folder / "out" / name, kOldManifest);
        put(folder / "out/notes.txt", "foreign");
        const std::string fresh = R"({ "version": 1, "generator": "Lumel", "new": true })";
        for (const std::string& name : new_names) put(folder / ("out.partial" + process) / name, fresh);
        for (std::size_t k = 0; k < done; ++k) fs::rename(folder / moves[k][0], folder / moves[k][1]);
        {
            const auto next = OutputFolder::create(folder / "out");
            ASSERT_TRUE(next.ok()) << done << ": " << next.error().text();
        }
        const bool newer = done == moves.size();
        Names expected = newer ? new_names : old_names;
        for (const std::string& name : expected)
            EXPECT_EQ(text_of(folder / "out" / name), newer ? fresh : kOldManifest) << done << " " << name;
        expected.insert("notes.txt");
        EXPECT_EQ(names_in(folder / "out"), expected) << done;
        EXPECT_EQ(folder.entries(), 1u) << done;
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
