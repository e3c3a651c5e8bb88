#include "io/mask_groups.h"

#include <gtest/gtest.h>

namespace lumel {
namespace {

TEST(MaskGroups, AreAsManyAsCharts) {
    const auto groups = parse_mask_groups("[2, 0, 2]", 3, "groups.json");
    ASSERT_TRUE(groups.ok()) << groups.error().text();
    EXPECT_EQ(groups->group_of, (std::vector<std::uint32_t>{2, 0, 2}));
    EXPECT_EQ(groups->groups, 3u);
}

TEST(MaskGroups, SayWhatIsWrong) {
    const auto error = [](const char* text) {
        const auto groups = parse_mask_groups(text, 2, "groups.json");
        return groups.ok() ? std::string("no error") : groups.error().text();
    };
    for (const char* text : {"[0]", "[0, 1, 1]", "{}", "3"})
        EXPECT_NE(error(text).find("groups.json: is no list of the groups of 2 charts"), std::string::npos) << text;
    for (const char* text : {"[0, -1]", "[0, 1.5]", "[0, \"1\"]", "[0, 3]", "[0, null]"})
        EXPECT_NE(error(text).find("group of chart 1"), std::string::npos) << error(text);
    EXPECT_NE(error("[0, ").find("groups.json"), std::string::npos);
}

}  // namespace
}  // namespace lumel
