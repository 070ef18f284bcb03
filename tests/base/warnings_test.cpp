#include "interflect/core.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

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

// Fails when every message has its entry.
TEST(Warnings, SummariseAKindWithManyMessages) {
    constexpr std::int64_t count = 300'000;
    Warnings warnings;
    warnings.add("missing-file", "there is no file");
    for (std::int64_t i = 0; i < count; ++i)
        warnings.add("extension", "the extension " + std::to_string(i) + " is ignored", "a.gltf:" + std::to_string(i));
    warnings.add("extension", "the extension 7 is ignored");
    warnings.add("missing-file", "there is no other file");

    const std::vector<Warnings::Entry>& entries = warnings.entries();
    constexpr std::size_t listed = 100;
    ASSERT_EQ(entries.size(), listed + 3);
    EXPECT_EQ(entries[8].count, 2) << "the extension 7 is listed";
    const Warnings::Entry& rest = entries[listed + 1];
    EXPECT_EQ(rest.kind, "extension");
    EXPECT_EQ(rest.message, "more warnings of the kind 'extension', each with its own text");
    EXPECT_EQ(rest.where, "a.gltf:100") << "the first that is not listed";
    EXPECT_EQ(rest.count, count - static_cast<std::int64_t>(listed));
    EXPECT_EQ(entries.back().message, "there is no other file");
}

TEST(Warnings, StartsEmpty) { EXPECT_TRUE(Warnings().entries().empty()); }

}  // namespace
}  // namespace interflect
