#include "suggest.h"

#include <gtest/gtest.h>

namespace lumel::cli {
namespace {

const std::vector<std::string> kOptions{"--samples", "--sky", "--sun-direction", "--sun-angle", "--seed", "--error"};

TEST(Suggest, OneSlipIsSeenThrough) {
    EXPECT_EQ(closest_word("--sample", kOptions), "--samples");
    EXPECT_EQ(closest_word("--smaples", kOptions), "--samples");     // swapped
    EXPECT_EQ(closest_word("--sampels", kOptions), "--samples");     // swapped
    EXPECT_EQ(closest_word("--sunangle", kOptions), "--sun-angle");  // left out
    EXPECT_EQ(closest_word("--eror", kOptions), "--error");
    EXPECT_EQ(closest_word("--sqy", kOptions), "--sky");
}

TEST(Suggest, TheBeginningOfAWordIsEnough) { EXPECT_EQ(closest_word("--sun", kOptions), "--sun-direction"); }

TEST(Suggest, OtherWordsAreNotGuessed) {
    EXPECT_EQ(closest_word("--frobnicate", kOptions), "");
    EXPECT_EQ(closest_word("--", kOptions), "");
    EXPECT_EQ(closest_word("", kOptions), "");
    EXPECT_EQ(closest_word("--samples", {}), "");
    EXPECT_EQ(closest_word("--xxy", kOptions), "");  // two slips of three letters
}

}  // namespace
}  // namespace lumel::cli
