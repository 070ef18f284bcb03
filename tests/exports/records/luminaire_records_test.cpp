// Photometry in solution files: a web shared by luminaires is stored once, and every number is preserved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

#include "interflect/exports/records/luminaire_records.h"

namespace interflect {

using namespace detail;
namespace {

std::shared_ptr<PhotometricWeb> uneven_web() {
    auto web = std::make_shared<PhotometricWeb>();
    web->name = "lamp.ies";
    web->pole = PhotometricWeb::Pole::c90;
    web->polar = {0, 70.3f, 100}, web->azimuth = {-30, 60.1f, 150};
    web->intensities = {10, 20, 0, 30, 5.1f, 0, 8, 9, 1};
    web->opening = {LuminousOpening::Shape::cylinder, {0.3f, 0.2f, 0.1f}, 1};
    web->lamp_lumens = 1234.5;
    return web;
}

void expect_same(const PhotometricWeb& found, const PhotometricWeb& written) {
    EXPECT_EQ(found.name, written.name);
    EXPECT_EQ(found.pole, written.pole);
    EXPECT_EQ(found.polar, written.polar);
    EXPECT_EQ(found.azimuth, written.azimuth);
    EXPECT_EQ(found.intensities, written.intensities);
    EXPECT_EQ(found.opening.shape, written.opening.shape);
    EXPECT_EQ(found.opening.size, written.opening.size);
    EXPECT_EQ(found.opening.axis, written.opening.axis);
    EXPECT_EQ(found.lamp_lumens, written.lamp_lumens);
}

TEST(LuminaireRecords, ShareTheirWeb) {
    const auto web = uneven_web(), other = std::make_shared<PhotometricWeb>(*web);
    other->opening.shape = LuminousOpening::Shape::ellipsoid;
    const std::vector<Luminaire> written{
        {"a", 2, MeasuredLight{web, {1.1f, 2, 3}, {0.1f, 0, -1}, {1, 1, 0.3f}, true, {1, 0.9f, 0.7f}}},
        {"b", 0, MeasuredLight{web, {4, 5, 6}, {0, 0, 1}, {0, 1, 0}, false, {2, 2, 2}}},
        {"c", 0, MeasuredLight{other, {4, 5, 6}, {0, 0, 1}, {0, 1, 0}, false, {2, 2, 2}}}};
    WebTable table;
    std::vector<Json> records;
    for (const Luminaire& luminaire : written) records.push_back(json_of(luminaire, table));
    const auto webs = webs_of(Json::parse(table.json().dump()));
    ASSERT_EQ(webs.size(), 2u);
    for (std::size_t i = 0; i < written.size(); ++i) {
        const Luminaire read = luminaire_of(Json::parse(records[i].dump()), webs);
        const auto &found = std::get<MeasuredLight>(read.kind), &expected = std::get<MeasuredLight>(written[i].kind);
        EXPECT_EQ(read.name, written[i].name);
        EXPECT_EQ(read.object, written[i].object);
        EXPECT_EQ(found.position, expected.position);
        EXPECT_EQ(found.direction, expected.direction);
        EXPECT_EQ(found.c0, expected.c0);
        EXPECT_EQ(found.mirrored, expected.mirrored);
        EXPECT_EQ(found.factor, expected.factor);
        expect_same(*found.web, *expected.web);
    }
}

TEST(LuminaireRecords, WithoutTheirWebAreRefused) {
    WebTable table;
    const Json record = json_of({"a", 0, MeasuredLight{uneven_web()}}, table);
    EXPECT_THROW(luminaire_of(record, {}), std::exception);
    Json webs = table.json();
    webs[0]["opening"]["shape"] = "star";
    EXPECT_THROW(webs_of(webs), std::runtime_error);
}

}  // namespace
}  // namespace interflect
