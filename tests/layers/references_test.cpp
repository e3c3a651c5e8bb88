// What the code is "Based on:" stands in docs/references.bib. Every year in such a comment needs an entry of that year
// of which the comment names an author or the title. Works without a year (web pages, libraries) are not looked for.
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>
#include <vector>

#include "source_tree.h"

namespace {

using lumel::test::kSourceTree;

struct Reference {
    std::string year;
    std::vector<std::string> names;  // any of these in the comment will do
};

// LaTeX's accented letters and the comment's UTF-8 ones are left out alike: M{\"u}ller and Müller are both Mller.
std::string plain(std::string text) {
    text = std::regex_replace(text, std::regex(R"(\{\\[^{}]*(\{[^{}]*\})?[^{}]*\})"), "");
    std::erase_if(text, [](char c) { return c == '{' || c == '}' || c == '\\' || (c & 0x80) != 0; });
    return text;
}

std::string field(const std::string& entry, const std::string& name) {
    const std::size_t at = entry.find(name + "={");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + name.size() + 2;
    std::size_t end = begin;
    for (int depth = 1; end < entry.size(); ++end) {
        depth += entry[end] == '{' ? 1 : entry[end] == '}' ? -1 : 0;
        if (depth == 0) break;
    }
    return entry.substr(begin, end - begin);
}

// One line of the file: its surnames, or the first word of what is no person ("Khronos" of {Khronos Group}).
Reference parse(const std::string& entry) {
    Reference out{field(entry, "year"), {plain(field(entry, "title"))}};
    static const std::regex kAnd(" and ");
    const std::string authors = field(entry, "author");
    for (std::sregex_token_iterator it(authors.begin(), authors.end(), kAnd, -1), end; it != end; ++it) {
        const std::string author = *it;
        const std::string name = plain(author);
        const bool person = author.empty() || author[0] != '{' || author[1] == '\\';
        const std::string word = person ? name.substr(name.rfind(' ') + 1) : name.substr(0, name.find(' '));
        if (word.size() > 2 && word != "others" && word != "The") out.names.push_back(word);
    }
    return out;
}

std::vector<Reference> references() {
    std::vector<Reference> out;
    for (const std::string& line : lumel::test::lines_of(kSourceTree / "docs/references.bib"))
        if (line.starts_with("@")) out.push_back(parse(line));
    return out;
}

// Years in `comment` that no reference has.
std::set<std::string> unknown_years(const std::string& comment, const std::vector<Reference>& references) {
    static const std::regex kYear(R"(\b(1[789]\d\d|20[0-3]\d)\b)");
    const std::string text = plain(comment);
    const auto known = [&](const std::string& year) {
        for (const Reference& reference : references)
            if (reference.year == year)
                for (const std::string& name : reference.names)
                    if (text.find(name) != std::string::npos) return true;
        return false;
    };
    std::set<std::string> out;
    for (std::sregex_iterator it(text.begin(), text.end(), kYear), end; it != end; ++it)
        if (!known((*it)[1])) out.insert((*it)[1]);
    return out;
}

// From `line` on, without the slashes, to the end of the comment.
std::string rest_of_comment(const std::vector<std::string>& lines, std::size_t line) {
    std::string out = lines[line].substr(lines[line].find("Based on:"));
    for (++line; line < lines.size(); ++line) {
        const std::size_t begin = lines[line].find_first_not_of(' ');
        if (begin == std::string::npos || lines[line].compare(begin, 2, "//") != 0) break;
        out += lines[line].substr(begin + 2);
    }
    return out;
}

TEST(References, WhatTheCodeIsBasedOnStandsInTheList) {
    const std::vector<Reference> known = references();
    ASSERT_GT(known.size(), 50u);
    int comments = 0;
    for (const char* folder : {"src", "include", "cli", "bench", "samples", "tests/analytic", "tests/support"})
        for (const auto& path : lumel::test::sources_below(kSourceTree / folder)) {
            const std::vector<std::string> lines = lumel::test::lines_of(path);
            for (std::size_t i = 0; i < lines.size(); ++i) {
                if (lines[i].find("// ") == std::string::npos || lines[i].find("Based on:") == std::string::npos)
                    continue;
                ++comments;
                for (const std::string& year : unknown_years(rest_of_comment(lines, i), known))
                    ADD_FAILURE() << path.string() << ":" << i + 1 << ": docs/references.bib has no work of " << year
                                  << " whose author or title the comment names";
            }
        }
    EXPECT_GT(comments, 80) << "the comments are not found";
}

TEST(References, AnEntryIsKnownByYearAndAuthorOrTitle) {
    const std::vector<Reference> list{
        parse(R"(@article{M, author={Thomas M{\"u}ller and Jan Nov{\'a}k}, title={Practical Guiding}, year={2017}})"),
        parse("@misc{K, author={{Khronos Group}}, title={Neutral}, year={2024}}"),
        parse("@misc{B, author={{Mr F}}, title={Baking lightmaps}, year={2018}}")};
    EXPECT_TRUE(unknown_years("Müller et al. 2017; Khronos 2024", list).empty());
    EXPECT_TRUE(unknown_years("the article \"Baking lightmaps\" (2018), 4096 rays", list).empty());
    EXPECT_EQ(unknown_years("Müller 2018; Hestenes and Stiefel 1952", list), (std::set<std::string>{"1952", "2018"}));
}

}  // namespace
