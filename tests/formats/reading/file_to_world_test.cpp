#include "interflect/formats/reading/file_to_world.h"

#include <gtest/gtest.h>

#include <array>

#include "interflect/formats/mesh/obj/obj.h"
#include "interflect/load.h"
#include "tests/support/refusals.h"

namespace interflect {

using namespace detail;
namespace {

using Imath::V3d;

struct Up {
    Axis axis;
    V3d direction, of_x;  // in the file; the image of x
};
void PrintTo(const Up& up, std::ostream* out) {
    constexpr std::array names{"x", "minus_x", "y", "minus_y", "z", "minus_z"};
    *out << names.at(static_cast<std::size_t>(up.axis));
}
class FileToWorld : public testing::TestWithParam<Up> {};

TEST_P(FileToWorld, TurnsUpToZAndScales) {
    const Imath::M44d m = file_to_world({.unit = 0.5, .up_axis = GetParam().axis});
    EXPECT_EQ(GetParam().direction * m, V3d(0, 0, 0.5));
    EXPECT_EQ(V3d(1, 0, 0) * m, 0.5 * GetParam().of_x);
    EXPECT_EQ(m.determinant(), 0.125);  // no mirror image
}

INSTANTIATE_TEST_SUITE_P(, FileToWorld,
                         testing::Values(Up{Axis::x, {1, 0, 0}, {0, 0, 1}}, Up{Axis::minus_x, {-1, 0, 0}, {0, 0, -1}},
                                         Up{Axis::y, {0, 1, 0}, {1, 0, 0}}, Up{Axis::minus_y, {0, -1, 0}, {1, 0, 0}},
                                         Up{Axis::z, {0, 0, 1}, {1, 0, 0}}, Up{Axis::minus_z, {0, 0, -1}, {1, 0, 0}}),
                         testing::PrintToStringParamName());

TEST(ReadOptions, UnitOutsideItsRangeIsRefused) {
    for (const double unit : {0.0, -1.0, 1e10, 0.0 / 0.0}) {
        const auto read = [&] { read_obj_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj", {.unit = unit}); };
        testing_support::expect_in(testing_support::message_of(read), "unit: expected");
    }
}

}  // namespace
}  // namespace interflect
