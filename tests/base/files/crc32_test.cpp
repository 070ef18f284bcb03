#include "interflect/base/files/crc32.h"

#include <gtest/gtest.h>

#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

TEST(Crc32, HasTheCheckValueOfItsDefinition) { EXPECT_EQ(text_of_crc32(crc32("123456789")), "cbf43926"); }

TEST(Crc32, GoesOnFromTheBytesBefore) { EXPECT_EQ(crc32("6789", crc32("12345")), crc32("123456789")); }

TEST(Crc32, OfAFileIsThatOfItsBytes) {
    const testing_support::TemporaryFolder folder;
    const std::string bytes(700'001, 'x');  // longer than the buffer
    EXPECT_EQ(crc32_of_file(folder.write("long", bytes)), crc32(bytes));
    EXPECT_EQ(crc32_of_file(folder.write("empty", "")), 0u);
    EXPECT_THROW(crc32_of_file(folder.path() / "missing"), std::runtime_error);
}

}  // namespace
}  // namespace interflect
