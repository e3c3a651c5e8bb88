// Diagnostics merge by code, and a failed check prints its values.
#include "lumel/context.h"

#include <gtest/gtest.h>

#include <string>

#include "base/check.h"
#include "base/try.h"

namespace lumel {
namespace {

TEST(Diagnostics, MergeByCodeAndKeepTheFirstExamples) {
    Diagnostics diagnostics;
    for (int i = 0; i < 20; ++i) diagnostics.add("uv-overlap", "charts overlap", "mesh " + std::to_string(i), 3);
    diagnostics.add("zero-area", "triangles without area get no texels", "mesh 7");
    ASSERT_EQ(diagnostics.all().size(), 2u);
    EXPECT_EQ(diagnostics.count("uv-overlap"), 60u);
    EXPECT_EQ(diagnostics.count("zero-area"), 1u);
    EXPECT_EQ(diagnostics.count("unheard-of"), 0u);
    ASSERT_EQ(diagnostics.all()[0].examples.size(), Diagnostics::kMaxExamples);
    EXPECT_EQ(diagnostics.all()[0].examples.front(), "mesh 0");
}

TEST(Context, ZeroThreadsMeansTheMachines) {
    EXPECT_GE(Context(0).threads(), 1u);
    EXPECT_EQ(Context(3).threads(), 3u);
}

TEST(CheckDeathTest, PrintsConditionAndValues) {
    const int texel = 42;
    EXPECT_DEATH(LUMEL_CHECK(texel < 10, "texel", texel), "texel < 10.*texel 42");
}

Result<int> half(int value) {
    if (value % 2) return Error{ErrorCode::invalid_input, "odd", "number " + std::to_string(value), "double it"};
    return value / 2;
}

Result<int> quarter(int value) {
    LUMEL_TRY(const int once, half(value));
    LUMEL_TRY(const int twice, half(once));
    return twice;
}

TEST(Result, TryPassesValuesOnAndErrorsUp) {
    ASSERT_TRUE(quarter(12).ok());
    EXPECT_EQ(*quarter(12), 3);
    ASSERT_FALSE(quarter(6).ok());
    EXPECT_EQ(quarter(6).error().text(), "number 3: odd (double it)");
}

}  // namespace
}  // namespace lumel
