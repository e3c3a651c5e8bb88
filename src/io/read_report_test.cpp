#include "io/read_report.h"

#include <gtest/gtest.h>

#include "io/check_report.h"

namespace lumel {
namespace {

TEST(ReadReport, TakesWarningsAndWhatWasSolved) {
    const auto remarks = parse_remarks(
        R"({"options": {"seams": true}, "warnings": [{"code": "uv-bleeding", "message": "charts share texels",
            "count": 3, "examples": ["mesh 0", "mesh 1"]}]})",
        "report.json");
    ASSERT_TRUE(remarks.ok());
    EXPECT_TRUE(remarks->seams_solved);
    ASSERT_EQ(remarks->warnings.size(), 1u);
    EXPECT_EQ(remarks->warnings[0].code, "uv-bleeding");
    EXPECT_EQ(remarks->warnings[0].count, 3u);
    EXPECT_EQ(remarks->warnings[0].examples.back(), "mesh 1");
}

TEST(ReadReport, NamesTheFileThatIsDamaged) {
    for (const char* text : {"{", R"({"warnings": 1})", R"({"warnings": [{}]})", R"({"options": {"seams": 2}})",
                             R"({"warnings": [{"code": "c", "message": "m", "count": 1, "examples": [7]}]})"}) {
        const auto remarks = parse_remarks(text, "report.json");
        ASSERT_FALSE(remarks.ok()) << text;
        EXPECT_EQ(remarks.error().where.substr(0, 11), "report.json") << text;
    }
}

TEST(CheckReport, AdvisesToSolveSeamsThatShow) {
    const CheckedBake bake;
    SeamCheck seams;
    const TexelCheck texels;
    BakeRemarks remarks;
    const CheckReport report{bake, seams, texels, {}, remarks};
    EXPECT_EQ(advice(report), "") << "there are no seams";
    seams.open.metres = 10.0;
    seams.open.visible_metres = 0.1;
    EXPECT_EQ(advice(report), "") << "no more than a hundredth shows";
    seams.open.visible_metres = 1.0;
    EXPECT_NE(advice(report).find("--seams on"), std::string::npos);
    EXPECT_NE(advice(report).find("10.0 %"), std::string::npos);
    remarks.seams_solved = true;
    EXPECT_EQ(advice(report), "") << "they are solved already";
}

}  // namespace
}  // namespace lumel
