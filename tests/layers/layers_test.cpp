// The house rules that a machine can check: who may include whom (src/LAYERS), where the headers of others may be seen,
// no exceptions out of src/, a head comment on every header.
#include <fnmatch.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "source_tree.h"

namespace fs = std::filesystem;

namespace {

using lumel::test::lines_of;
using lumel::test::sources_below;

const fs::path kRoot = lumel::test::kSourceTree;

struct ForeignHeader {
    std::string header;              // glob over what stands between < and >
    std::vector<std::string> files;  // globs over paths below src/
};

struct Layers {
    std::map<std::string, std::set<std::string>> may_include;
    std::vector<ForeignHeader> foreign;
};

struct Include {
    std::string file;  // below the root searched, with / between folders
    int line = 0;
    bool angled = false;
    std::string target;

    [[nodiscard]] std::string text() const {
        return file + ":" + std::to_string(line) + ": #include " + (angled ? "<" + target + ">" : "\"" + target + "\"");
    }
};

std::vector<std::string> words(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> out;
    for (std::string word; stream >> word;) out.push_back(word);
    return out;
}

// Throws what a test reports: a LAYERS that cannot be read must not pass for one that forbids nothing.
Layers parse_layers(std::istream& stream) {
    Layers layers;
    for (std::string line; std::getline(stream, line);) {
        line = line.substr(0, line.find('#'));
        if (words(line).empty()) continue;
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos) throw std::runtime_error("LAYERS: no colon in: " + line);
        const std::vector<std::string> left = words(line.substr(0, colon)), right = words(line.substr(colon + 1));
        if (left.empty()) throw std::runtime_error("LAYERS: nothing before the colon in: " + line);
        if (left[0][0] != '<') {
            layers.may_include[left[0]] = {right.begin(), right.end()};
            continue;
        }
        for (const std::string& header : left) layers.foreign.push_back({header.substr(1, header.size() - 2), right});
    }
    return layers;
}

Layers project_layers() {
    std::ifstream stream(kRoot / "src/LAYERS");
    if (!stream) throw std::runtime_error("no src/LAYERS");
    return parse_layers(stream);
}

std::vector<Include> includes_of(const std::vector<std::string>& lines, const std::string& file) {
    static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^">]+)[">])");
    std::vector<Include> out;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::smatch match;
        if (std::regex_search(lines[i], match, kInclude))
            out.push_back({file, static_cast<int>(i) + 1, match[1] == "<", match[2]});
    }
    return out;
}

std::vector<Include> includes_below(const fs::path& root) {
    std::vector<Include> out;
    for (const fs::path& path : sources_below(root)) {
        const auto found = includes_of(lines_of(path), fs::relative(path, root).generic_string());
        out.insert(out.end(), found.begin(), found.end());
    }
    return out;
}

std::string first_folder(const std::string& path) { return path.substr(0, path.find('/')); }

bool is_test(const std::string& file) { return file.ends_with("_test.cpp"); }

bool matches(const std::string& glob, const std::string& text) { return fnmatch(glob.c_str(), text.c_str(), 0) == 0; }

// The standard library's own headers have neither a folder nor an extension.
bool is_standard(const std::string& header) { return header.find_first_of("./") == std::string::npos; }

// Empty if the include is in order, else what is wrong with it. Test programs link everything, so they may include any
// module; headers of others are bound for them too.
std::string complaint(const Include& include, const Layers& layers) {
    if (include.angled) {
        if (is_standard(include.target)) return {};
        bool known = false;
        for (const ForeignHeader& foreign : layers.foreign) {
            if (!matches(foreign.header, include.target)) continue;
            known = true;
            for (const std::string& file : foreign.files)
                if (matches(file, include.file)) return {};
        }
        return include.text() + (known ? ": LAYERS keeps this header elsewhere" : ": LAYERS does not know this header");
    }
    const std::string from = first_folder(include.file), to = first_folder(include.target);
    if (to == "lumel" || to == from) return {};
    if (is_test(include.file) && (to == "support" || layers.may_include.contains(to))) return {};
    const auto allowed = layers.may_include.find(from);
    if (allowed == layers.may_include.end()) return include.text() + ": LAYERS does not know the module " + from;
    if (!allowed->second.contains(to)) return include.text() + ": " + from + " may not include " + to;
    return {};
}

// The headers below src/ that include, themselves or through others, what LAYERS lists as a header of others.
std::set<std::string> headers_that_bring_others(const std::vector<Include>& includes, const Layers& layers) {
    std::set<std::string> out;
    for (const Include& include : includes)
        for (const ForeignHeader& foreign : layers.foreign)
            if (include.angled && matches(foreign.header, include.target)) out.insert(include.file);
    for (std::size_t before = 0; before != out.size();) {
        before = out.size();
        for (const Include& include : includes)
            if (!include.angled && out.contains(include.target)) out.insert(include.file);
    }
    return out;
}

// Removes, round by round, the modules that include nothing left; what cannot be removed is on a cycle, or includes
// one.
std::set<std::string> modules_on_cycles(Layers layers) {
    for (bool removed = true; removed;) {
        removed = false;
        for (auto it = layers.may_include.begin(); it != layers.may_include.end(); ++it) {
            if (!it->second.empty()) continue;
            const std::string module = it->first;
            layers.may_include.erase(it);
            for (auto& [name, others] : layers.may_include) others.erase(module);
            removed = true;
            break;
        }
    }
    std::set<std::string> left;
    for (const auto& [name, others] : layers.may_include) left.insert(name);
    return left;
}

// The code of a line: without its // comment and its string literals.
std::string code_of(const std::string& line) {
    static const std::regex kString(R"("(\\.|[^"\\])*")");
    const std::string bare = std::regex_replace(line, kString, "\"\"");
    return bare.substr(0, bare.find("//"));
}

}  // namespace

TEST(Layers, NamesTheModulesThatThereAre) {
    std::set<std::string> folders, listed;
    for (const fs::directory_entry& entry : fs::directory_iterator(kRoot / "src"))
        if (entry.is_directory()) folders.insert(entry.path().filename().string());
    for (const auto& [name, others] : project_layers().may_include) {
        listed.insert(name);
        for (const std::string& other : others) EXPECT_TRUE(folders.contains(other)) << name << " lists " << other;
    }
    EXPECT_EQ(folders, listed);
    EXPECT_GE(folders.size(), 10u);
}

TEST(Layers, HaveNoCycle) { EXPECT_EQ(modules_on_cycles(project_layers()), std::set<std::string>{}); }

TEST(Layers, EveryIncludeOfSrcPointsDown) {
    const Layers layers = project_layers();
    const std::vector<Include> includes = includes_below(kRoot / "src");
    EXPECT_GE(includes.size(), 100u) << "the search found next to nothing";
    for (const Include& include : includes) EXPECT_EQ(complaint(include, layers), "");
}

TEST(Layers, HeadersThatBringOthersStayInTheirModule) {
    const Layers layers = project_layers();
    const std::vector<Include> includes = includes_below(kRoot / "src");
    const std::set<std::string> bring_others = headers_that_bring_others(includes, layers);
    for (const Include& include : includes) {
        if (is_test(include.file) || include.target == "base/denormals.h") continue;  // intrinsics, of the compiler
        if (first_folder(include.file) == first_folder(include.target)) continue;
        EXPECT_FALSE(bring_others.contains(include.target)) << include.text() << ": brings a header of others along";
    }
}

TEST(Layers, EveryQuotedIncludeIsAFileOfOurs) {
    for (const Include& include : includes_below(kRoot / "src")) {
        if (include.angled) continue;
        const bool found = fs::exists(kRoot / "src" / include.target) ||
                           fs::exists(kRoot / "include" / include.target) ||
                           (is_test(include.file) && fs::exists(kRoot / "tests" / include.target));
        EXPECT_TRUE(found) << include.text() << ": write it from src/ or include/";
    }
}

// A user's compiler sees these and nothing else of ours, and no third party.
TEST(Layers, PublicHeadersIncludeOnlyEachOther) {
    const std::vector<Include> includes = includes_below(kRoot / "include");
    EXPECT_GE(includes.size(), 10u);
    for (const Include& include : includes) {
        const bool fine = include.angled ? is_standard(include.target) : first_folder(include.target) == "lumel";
        EXPECT_TRUE(fine) << include.text();
    }
}

// The one use left: a callback of a third party that can report in no other way. It says where it is "caught in".
TEST(House, NothingThrowsOutOfSrc) {
    static const std::regex kThrow(R"(\bthrow\b)");
    for (const fs::path& path : sources_below(kRoot / "src")) {
        const std::vector<std::string> lines = lines_of(path);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const bool says_where = lines[i].find("caught in") != std::string::npos ||
                                    (i > 0 && lines[i - 1].find("caught in") != std::string::npos);
            if (says_where) continue;
            EXPECT_FALSE(std::regex_search(code_of(lines[i]), kThrow)) << path << ":" << i + 1 << ": " << lines[i];
        }
    }
}

TEST(House, EveryHeaderSaysWhatItIs) {
    for (const char* folder : {"src", "include"}) {
        for (const fs::path& path : sources_below(kRoot / folder)) {
            if (path.extension() != ".h") continue;
            const std::vector<std::string> lines = lines_of(path);
            ASSERT_FALSE(lines.empty()) << path;
            EXPECT_TRUE(lines[0].starts_with("//") || lines[0].starts_with("/*")) << path << ": no head comment";
            EXPECT_NE(std::find(lines.begin(), lines.end(), "#pragma once"), lines.end()) << path;
        }
    }
}

// ---- The checker itself: each rule is seen to bite ------------------------------------------------------------------

namespace {

Layers example_layers() {
    std::istringstream text("low:\nhigh: low # a remark\n<foreign/*>: low/edge.cpp\n");
    return parse_layers(text);
}

}  // namespace

TEST(LayersChecker, LetsThroughWhatIsAllowed) {
    const Layers layers = example_layers();
    EXPECT_EQ(complaint({"high/a.cpp", 1, false, "low/b.h"}, layers), "");
    EXPECT_EQ(complaint({"high/a.cpp", 1, false, "high/b.h"}, layers), "");
    EXPECT_EQ(complaint({"high/a.cpp", 1, false, "lumel/scene.h"}, layers), "");
    EXPECT_EQ(complaint({"low/a_test.cpp", 1, false, "high/b.h"}, layers), "");
    EXPECT_EQ(complaint({"low/a.cpp", 1, true, "vector"}, layers), "");
    EXPECT_EQ(complaint({"low/edge.cpp", 1, true, "foreign/x.h"}, layers), "");
}

TEST(LayersChecker, RefusesWhatIsNot) {
    const Layers layers = example_layers();
    EXPECT_NE(complaint({"low/a.h", 1, false, "high/b.h"}, layers), "") << "upwards";
    EXPECT_NE(complaint({"unknown/a.h", 1, false, "low/b.h"}, layers), "") << "a module that LAYERS lacks";
    EXPECT_NE(complaint({"high/a.h", 1, false, "support/b.h"}, layers), "") << "test support outside a test";
    EXPECT_NE(complaint({"low/a.h", 1, false, "b.h"}, layers), "") << "a path without its module";
    EXPECT_NE(complaint({"high/a.cpp", 1, true, "foreign/x.h"}, layers), "") << "a foreign header inside";
    EXPECT_NE(complaint({"low/edge.cpp", 1, true, "stray.h"}, layers), "") << "a foreign header nobody listed";
}

TEST(LayersChecker, FollowsAForeignHeaderThroughOurs) {
    const std::vector<Include> includes = {{"low/edge.h", 1, true, "foreign/x.h"},
                                           {"low/a.h", 1, false, "low/edge.h"},
                                           {"high/b.h", 1, false, "low/a.h"},
                                           {"high/c.h", 1, false, "low/clean.h"}};
    EXPECT_EQ(headers_that_bring_others(includes, example_layers()),
              (std::set<std::string>{"low/edge.h", "low/a.h", "high/b.h"}));
}

TEST(LayersChecker, FindsACycle) {
    std::istringstream text("free:\na: b free\nb: c\nc: a\n");
    EXPECT_EQ(modules_on_cycles(parse_layers(text)), (std::set<std::string>{"a", "b", "c"}));
}

TEST(LayersChecker, ReadsIncludesAsTheyAreWritten) {
    const auto includes =
        includes_of({"#include <vector>", "  #  include \"low/b.h\"  // why", "// #include <no>"}, "f");
    ASSERT_EQ(includes.size(), 2u);
    EXPECT_TRUE(includes[0].angled);
    EXPECT_EQ(includes[1].target, "low/b.h");
    EXPECT_EQ(includes[1].line, 2);
}

TEST(LayersChecker, DoesNotTakeACommentOrAStringForCode) {
    EXPECT_EQ(code_of("x = \"throw // it\";  // never throw"), "x = \"\";  ");
}
