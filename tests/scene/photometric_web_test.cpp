// Photometric webs: intensities between the angles of the table, and the flux, against closed forms.
//
// Seen to fail when C0 and C90 are exchanged, when azimuth runs the other way around, when the flux lacks the sine.
#include "interflect/light_sources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace interflect {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

PhotometricWeb web_of(const std::vector<float>& polar, const std::vector<float>& azimuth,
                      const std::function<float(float, float)>& intensity) {
    PhotometricWeb web;
    web.polar = polar;
    web.azimuth = azimuth;
    for (const float phi : azimuth)
        for (const float theta : polar) web.intensities.push_back(intensity(theta, phi));
    return web;
}

const std::vector<float> all_around{0, 90, 180, 270, 360};

/// At 45 degrees from the nadir, towards C.
V3f slanted(float azimuth) {
    const float phi = azimuth * static_cast<float>(pi) / 180;
    return {std::cos(phi), std::sin(phi), -1};
}

TEST(PhotometricWeb, IsLinearBetweenItsAngles) {
    const PhotometricWeb web = web_of({0, 90, 180}, all_around, [](float t, float p) { return t + p; });
    EXPECT_NEAR(web.intensity({0, 0, -2}), 0 + 0, 1e-3) << "the nadir; C is 0 there";
    EXPECT_NEAR(web.intensity(slanted(0)), 45, 1e-3);
    EXPECT_NEAR(web.intensity(slanted(90)), 45 + 90, 1e-3);
    EXPECT_NEAR(web.intensity(slanted(210)), 45 + 210, 1e-3);
    EXPECT_NEAR(web.intensity({0, 1, 0}), 90 + 90, 1e-3) << "y is C90";
    EXPECT_NEAR(web.intensity({-1, 0, 1}), 135 + 180, 1e-3);
}

TEST(PhotometricWeb, OfTypeBHasItsPoleAtC90) {
    PhotometricWeb web = web_of({0, 90, 180}, {-180, -90, 0, 90, 180}, [](float t, float p) { return 500 + t + p; });
    web.pole = PhotometricWeb::Pole::c90;
    EXPECT_NEAR(web.intensity({0, 1, -1}), 500 + 45 + 0, 1e-3);
    EXPECT_NEAR(web.intensity({0, 0, -1}), 500 + 90 + 0, 1e-3);
    EXPECT_NEAR(web.intensity({1, 0, -1}), 500 + 90 + 45, 1e-3);
    EXPECT_NEAR(web.intensity({-1, 0, 0}), 500 + 90 - 90, 1e-3);
}

TEST(PhotometricWeb, IsDarkBeyondItsAngles) {
    const PhotometricWeb web = web_of({10, 60}, {-45, 45}, [](float, float) { return 7.0f; });
    EXPECT_FLOAT_EQ(web.intensity(slanted(44)), 7);
    EXPECT_FLOAT_EQ(web.intensity(slanted(-44)), 7);
    EXPECT_EQ(web.intensity(slanted(46)), 0);
    EXPECT_EQ(web.intensity({0, 0, -1}), 0);
    EXPECT_EQ(web.intensity({1, 0, -0.5f}), 0);
}

TEST(PhotometricWeb, AngleBeginsAnywhere) {
    const PhotometricWeb web = web_of({0, 180}, {270, 360, 450, 540, 630}, [](float, float p) { return p; });
    EXPECT_NEAR(web.intensity({1, 0, 0}), 360, 1e-3);
    EXPECT_NEAR(web.intensity({0, 1, 0}), 450, 1e-3);
    EXPECT_NEAR(web.intensity({-1, -1, 0}), 585, 1e-3);
}

TEST(PhotometricWeb, FluxOfTheSameIntensityEverywhereIsFourPi) {
    EXPECT_NEAR(web_of({0, 1, 70, 180}, all_around, [](float, float) { return 3; }).flux(), 4 * pi * 3, 1e-9);
}

/// For the hat 1 - t / 90: 2 pi times the integral of (1 - t / T) sin t from 0 to T = pi / 2, which is 1 - 1 / T.
TEST(PhotometricWeb, FluxIntegratesTheInterpolationExactly) {
    const double hat = 2 * pi * (1 - 2 / pi);
    EXPECT_NEAR(web_of({0, 90}, {0, 360}, [](float t, float) { return 1 - t / 90; }).flux(), hat, 1e-7);
    const auto sectors = [](float t, float p) { return (1 - t / 90) * (p == 180 ? 1.0f : 0.0f); };
    EXPECT_NEAR(web_of({0, 45, 90}, all_around, sectors).flux(), hat / 4, 1e-7) << "90 to 270, half of it on average";
}

TEST(PhotometricWeb, FaultsAreFound) {
    const PhotometricWeb good = web_of({0, 90}, {0, 360}, [](float, float) { return 1; });
    EXPECT_EQ(web_fault(good), "");
    const auto fault = [&](const std::function<void(PhotometricWeb&)>& change) {
        PhotometricWeb web = good;
        change(web);
        return web_fault(web);
    };
    EXPECT_THAT(fault([](auto& w) { w.polar = {0}; }), HasSubstr("fewer than two polar"));
    EXPECT_THAT(fault([](auto& w) { w.polar = {90, 0}; }), HasSubstr("do not ascend"));
    EXPECT_THAT(fault([](auto& w) { w.polar = {90, 190}; }), HasSubstr("beyond 180"));
    EXPECT_THAT(fault([](auto& w) { w.azimuth = {0, 361}; }), HasSubstr("too wide"));
    EXPECT_THAT(fault([](auto& w) { w.azimuth = {0, NAN}; }), HasSubstr("do not ascend"));
    EXPECT_THAT(fault([](auto& w) { w.intensities.pop_back(); }), HasSubstr("3 intensities for 2 x 2"));
    EXPECT_THAT(fault([](auto& w) { w.intensities[2] = -1; }), HasSubstr("an intensity of -1"));
    EXPECT_THAT(fault([](auto& w) { w.intensities[2] = INFINITY; }), HasSubstr("an intensity of inf"));
    EXPECT_THAT(fault([](auto& w) { w.intensities.assign(4, 0); }), HasSubstr("emits nothing"));
    EXPECT_THAT(fault([](auto& w) { w.lamp_lumens = -1; }), HasSubstr("flux"));
    EXPECT_THAT(fault([](auto& w) { w.opening.size = {1, -1, 1}; }), HasSubstr("opening"));
    EXPECT_THAT(fault([](auto& w) {
                    w.opening = {LuminousOpening::Shape::ellipsoid, {1, 1, 0}, 2};
                }),
                HasSubstr("opening"));
}

}  // namespace
}  // namespace interflect
