#include "base/memory_use.h"

#include <gtest/gtest.h>

#include <vector>

namespace lumel {
namespace {

TEST(PeakMemory, GrowsWithWhatIsTouched) {
    const std::uint64_t before = peak_memory();
    ASSERT_GT(before, std::uint64_t{1} << 20);
    constexpr std::size_t kBytes = std::size_t{192} << 20;
    {
        const std::vector<char> touched(kBytes, 1);
        EXPECT_EQ(touched[kBytes / 2], 1);
    }
    const std::uint64_t after = peak_memory();
    EXPECT_GT(after, kBytes);
    EXPECT_GE(after, before) << "a high-water mark does not fall";
}

TEST(Megabytes, AreRoundedUp) {
    EXPECT_EQ(megabytes(0), "0 MB");
    EXPECT_EQ(megabytes(1), "1 MB");
    EXPECT_EQ(megabytes(3u << 20), "3 MB");
    EXPECT_EQ(megabytes((3u << 20) + 1), "4 MB");
    EXPECT_EQ(megabytes(~std::uint64_t{0}), "17592186044416 MB");
}

}  // namespace
}  // namespace lumel
