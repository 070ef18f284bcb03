#include "interflect/core.h"

#include <gtest/gtest.h>

namespace interflect {
namespace {

TEST(Warnings, CountsOneEntryAKindAndMessage) {
    Warnings warnings;
    warnings.add("unsupported-entity", "'ies' is left out", "a.mgf:3");
    warnings.add("clamped-reflectance", "a reflectance above 0.99 is taken as 0.99", "a.mgf:5");
    warnings.add("unsupported-entity", "'ies' is left out", "a.mgf:9");
    warnings.add("unsupported-entity", "'cone2' is left out");

    ASSERT_EQ(warnings.entries().size(), 3u);
    EXPECT_EQ(warnings.entries()[0].kind, "unsupported-entity");
    EXPECT_EQ(warnings.entries()[0].count, 2);
    EXPECT_EQ(warnings.entries()[0].where, "a.mgf:3") << "the first occurrence";
    EXPECT_EQ(warnings.entries()[1].message, "a reflectance above 0.99 is taken as 0.99");
    EXPECT_EQ(warnings.entries()[1].count, 1);
    EXPECT_EQ(warnings.entries()[2].where, "");
}

TEST(Warnings, StartsEmpty) { EXPECT_TRUE(Warnings().entries().empty()); }

}  // namespace
}  // namespace interflect
