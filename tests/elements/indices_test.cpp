#include "interflect/indices.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "interflect/geometry/surfaces/corner_index.h"

namespace interflect {
namespace {

using detail::CornerIndex;

template <class Vector, class Index>
concept HasEntry = requires(Vector vector, Index i) {
    vector[i];
};

TEST(Indices, AreNotTakenForEachOther) {
    EXPECT_FALSE((std::is_constructible_v<PatchIndex, ElementIndex>)) << "an element is no patch";
    EXPECT_TRUE((std::is_convertible_v<PatchIndex, ElementIndex>)) << "a patch is its root element";
    EXPECT_FALSE((std::is_convertible_v<std::uint32_t, PatchIndex>));
    EXPECT_FALSE((std::is_convertible_v<std::uint32_t, ElementIndex>));
    EXPECT_FALSE((std::is_convertible_v<PatchIndex, CornerIndex>));
    EXPECT_FALSE((std::is_convertible_v<CornerIndex, PatchIndex>));
}

TEST(Indices, OfPatchesAndIntegersFindTheEntriesOfPatches) {
    EXPECT_TRUE((HasEntry<PerPatch<float>, PatchIndex>));
    EXPECT_TRUE((HasEntry<PerPatch<float>, std::size_t>));
    EXPECT_FALSE((HasEntry<PerPatch<float>, ElementIndex>));
    EXPECT_FALSE((HasEntry<const PerPatch<float>, ElementIndex>));
}

TEST(Indices, OfSiblingsFollowEachOther) {
    const ElementIndex first(20);
    EXPECT_EQ(first + 3, ElementIndex(23));
    std::uint32_t count = 0;
    for (ElementIndex e = first; e < first + 4; ++e) ++count;
    EXPECT_EQ(count, 4);
    EXPECT_EQ(PatchIndex(), no_patch);
    EXPECT_EQ(no_element, none);
}

TEST(Indices, OfCornersAreFourPerPatch) {
    const CornerIndex corner(PatchIndex(7), 2);
    EXPECT_EQ(corner.value, 30);
    EXPECT_EQ(corner.patch(), PatchIndex(7));
    EXPECT_EQ(corner.corner(), 2);
}

}  // namespace
}  // namespace interflect
