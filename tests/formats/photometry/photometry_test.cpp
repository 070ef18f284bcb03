// Photometric files of all types and symmetries, generated from functions of direction with known flux.
//
// Seen to fail when C0 and C90 are exchanged, when A and B count horizontal angles counter-clockwise, when a quadrant
// is mirrored once only, when planes of both sides of C0 begin at C90.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "interflect/core.h"
#include "interflect/formats/photometry/ies.h"
#include "interflect/formats/photometry/ldt.h"
#include "interflect/formats/photometry/write_ies.h"
#include "interflect/load.h"
#include "tests/support/scenes/photometry_files.h"
#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

using namespace testing_support;
using Imath::V3d;
using std::numbers::pi;

constexpr double degree = pi / 180;

using Distribution = std::function<double(const V3d&)>;

// Unit directions of LM-63's angles: z is up, C0 along x.
V3d type_c(double vertical, double horizontal) {
    const double t = vertical * degree, p = horizontal * degree;
    return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), -std::cos(t)};
}
V3d type_b(double vertical, double horizontal) {
    const double v = vertical * degree, h = horizontal * degree;
    return {std::cos(h) * std::sin(v), -std::sin(h), -std::cos(h) * std::cos(v)};
}
V3d type_a(double vertical, double horizontal) {
    const double v = vertical * degree, h = horizontal * degree;
    return {std::cos(v) * std::cos(h), -std::cos(v) * std::sin(h), std::sin(v)};
}

// Distributions [cd], by their symmetry, and their integrals over the sphere [lm].
double round_beam(const V3d& d) { return 120 * d.z * d.z; }
double both_planes(const V3d& d) { return 100 * (1 + d.x * d.x); }
double c0_plane(const V3d& d) { return 100 * (1 + 0.5 * d.x + 0.3 * d.y * d.y); }
double c90_plane(const V3d& d) { return 100 * (1 + 0.5 * d.y + 0.3 * d.x * d.x); }
double no_symmetry(const V3d& d) { return 100 * (1 + 0.4 * d.x - 0.3 * d.y + 0.2 * d.z); }
constexpr double sphere = 4 * pi * 100, round_flux = 160 * pi, both_flux = sphere * 4 / 3, plane_flux = sphere * 1.1;

struct Case {
    std::string name;
    int type;  // LM-63 type; 0: EULUMDAT
    std::vector<double> vertical, horizontal;
    Distribution distribution;
    double flux;
    std::function<bool(const V3d&)> is_covered = [](const V3d&) { return true; };
    int symmetry = 0;  // EULUMDAT symmetry
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

std::vector<Case> cases() {
    const auto full = range(0, 180, 5), right = range(0, 90, 5), turn = range(0, 360, 5),
               both_sides = range(-90, 90, 5), planes = range(0, 355, 5), all_planes = range(-180, 180, 5);
    const auto below = [](const V3d& d) { return d.z < 0; };
    const auto above = [](const V3d& d) { return d.z > 0; };
    const auto ahead = [](const V3d& d) { return d.x > 0; };
    return {{"c_rotation", 1, full, {0}, round_beam, round_flux},
            {"c_rotation_below", 1, right, {0}, round_beam, round_flux / 2, below},
            {"c_rotation_above", 1, range(90, 180, 5), {0}, round_beam, round_flux / 2, above},
            {"c_quadrant", 1, full, right, both_planes, both_flux},
            {"c_quadrant_below", 1, right, right, both_planes, both_flux / 2, below},
            {"c_0_to_180", 1, full, full, c0_plane, plane_flux},
            {"c_0_to_180_below", 1, right, full, c0_plane, plane_flux / 2, below},
            {"c_90_to_270", 1, full, range(90, 270, 5), c90_plane, plane_flux},
            {"c_minus_90_to_90", 1, full, both_sides, c90_plane, plane_flux},
            {"c_all_around", 1, full, turn, no_symmetry, sphere},
            {"c_all_around_open", 1, full, planes, no_symmetry, sphere},
            {"b_both_sides", 2, both_sides, both_sides, no_symmetry, sphere / 2 * 0.9, below},
            {"b_one_side", 2, both_sides, right, c0_plane, plane_flux / 2, below},
            {"b_quadrant", 2, right, right, both_planes, both_flux / 2, below},
            {"b_all_around", 2, all_planes, both_sides, no_symmetry, sphere},
            {"b_all_around_one_side", 2, all_planes, right, c0_plane, plane_flux},
            {"a_both_sides", 3, both_sides, both_sides, no_symmetry, sphere / 2 * 1.2, ahead},
            {"a_one_side", 3, both_sides, right, both_planes, both_flux / 2, ahead},
            {"a_quadrant", 3, right, right, both_planes, both_flux / 2, ahead},
            {"a_all_around", 3, both_sides, all_planes, no_symmetry, sphere},
            {"ldt_none", 0, full, planes, no_symmetry, sphere},
            {"ldt_rotation", 0, full, planes, round_beam, round_flux, below, 1},
            {"ldt_c0", 0, full, planes, c0_plane, plane_flux, below, 2},
            {"ldt_c90", 0, full, planes, c90_plane, plane_flux, below, 3},
            {"ldt_both", 0, full, planes, both_planes, both_flux, below, 4}};
}

class Photometry : public testing::TestWithParam<Case> {
  protected:
    PhotometricWeb read() {
        const Case& c = GetParam();
        const auto by = [&](auto direction) {
            return [&c, direction](double v, double h) { return c.distribution(direction(v, h)); };
        };
        if (c.type == 0)
            return read_ldt_text(
                LdtText{.symmetry = c.symmetry, .c = c.horizontal, .gamma = c.vertical, .intensity = by(type_c)}.str(),
                "made.ldt", {}, warnings);
        const IesText text{.type = c.type,
                           .vertical = c.vertical,
                           .horizontal = c.horizontal,
                           .intensity = c.type == 1   ? std::function<double(double, double)>(by(type_c))
                                        : c.type == 2 ? by(type_b)
                                                      : by(type_a)};
        return read_ies_text(text.str(), "made.ies", {}, warnings);
    }
    Warnings warnings;
};
INSTANTIATE_TEST_SUITE_P(All, Photometry, testing::ValuesIn(cases()), [](const auto& one) { return one.param.name; });

void expect_distribution(const PhotometricWeb& web, const Case& c) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const bool is_partial = c.type != 0;
    for (int i = 0; i < 300; ++i) {
        const V3d d = V3d(normal(random), normal(random), normal(random)).normalized();
        const double expected = !is_partial || c.is_covered(d) ? c.distribution(d) : 0;
        EXPECT_NEAR(web.intensity(V3f(d)), expected, 0.5) << d.x << ' ' << d.y << ' ' << d.z;
    }
}

TEST_P(Photometry, HasTheIntensitiesAndTheFlux) {
    const PhotometricWeb web = read();
    EXPECT_EQ(web_fault(web), "");
    expect_distribution(web, GetParam());
    EXPECT_NEAR(web.flux() / GetParam().flux, 1, 2e-3);
    const bool is_unusual = GetParam().name == "c_all_around_open" || GetParam().name.ends_with("b_quadrant") ||
                            GetParam().name.ends_with("a_quadrant");
    EXPECT_EQ(warnings.entries().size(), is_unusual ? 1u : 0u);
}

TEST_P(Photometry, ComesBackAsItWasWritten) {
    const PhotometricWeb web = read();
    std::ostringstream out;
    write_ies(web, out);
    Warnings none_expected;
    const PhotometricWeb back = read_ies_text(out.str(), "written.ies", {}, none_expected);
    EXPECT_TRUE(none_expected.entries().empty());
    expect_distribution(back, GetParam());
    EXPECT_NEAR(back.flux() / web.flux(), 1, 1e-6);
    EXPECT_EQ(back.opening.size, web.opening.size);
}

TEST(PhotometryFiles, AreToldByTheirExtension) {
    const TemporaryFolder folder;
    Warnings warnings;
    EXPECT_EQ(load_photometric_web(folder.write("a.IES", IesText().str()), {}, warnings).polar.size(), 2u);
    EXPECT_EQ(load_photometric_web(folder.write("a.ldt", LdtText().str()), {}, warnings).polar.size(), 2u);
    EXPECT_THROW(load_photometric_web(folder.write("a.txt", IesText().str()), {}, warnings), InputError);
}

}  // namespace
}  // namespace interflect
