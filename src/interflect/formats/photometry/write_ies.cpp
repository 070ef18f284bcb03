#include "interflect/formats/photometry/write_ies.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "interflect/base/files/pending_file.h"
#include "interflect/formats/photometry/photometric_planes.h"
#include "interflect/scene/core/web_angles.h"

namespace interflect::detail {

namespace {

using Column = std::vector<float>;

Column column_of(const PhotometricWeb& web, std::size_t i) {
    return {web.at_azimuth(i), web.at_azimuth(i) + web.polar.size()};
}

/// Returns the planes from 0 to 360 degrees. Interpolates the plane at 0 if it is missing.
PhotometricPlanes all_around(const PhotometricWeb& web) {
    constexpr auto turn = static_cast<float>(full_turn);
    std::map<float, Column> columns;
    for (std::size_t i = 0; i < web.azimuth.size(); ++i) {
        float angle = std::fmod(web.azimuth[i], turn);
        if (angle < 0) angle += turn;
        columns.emplace(angle, column_of(web, i));
    }
    if (columns.begin()->first > 0) {
        const auto& [first_angle, first] = *columns.begin();
        const auto& [last_angle, last] = *columns.rbegin();
        Column between = last;
        const float share = (turn - last_angle) / (turn - last_angle + first_angle);
        for (std::size_t j = 0; j < between.size(); ++j) between[j] += (first[j] - last[j]) * share;
        columns.emplace(0.0f, between);
    }
    std::vector<float> angles, intensities;
    for (const auto& [angle, column] : columns) {
        angles.push_back(angle);
        intensities.insert(intensities.end(), column.begin(), column.end());
    }
    PhotometricPlanes planes(angles, intensities);
    planes.close();
    return planes;
}

std::vector<float> shifted(std::vector<float> angles, float by) {
    for (float& angle : angles) angle += by;
    return angles;
}

/// Returns the sizes of LM-63, which are negative across round sections.
V3f dimensions(const LuminousOpening& opening) {
    V3f size = opening.size;
    for (int k = 0; k < 3; ++k)
        if (opening.shape == LuminousOpening::Shape::ellipsoid ||
            (opening.shape == LuminousOpening::Shape::cylinder && k != opening.axis))
            size[k] = 0 - size[k];
    return size;
}

}  // namespace

void write_ies(const PhotometricWeb& web, std::ostream& out) {
    const bool is_b = web.pole == PhotometricWeb::Pole::c90,
               is_c = !is_b && web.azimuth.back() - web.azimuth.front() == static_cast<float>(full_turn);
    PhotometricPlanes planes = is_c ? all_around(web) : PhotometricPlanes(web.azimuth, web.intensities);
    std::vector<float> vertical = web.polar, horizontal, intensities;
    if (is_b) {
        vertical = web.azimuth;
        horizontal = shifted(web.polar, -right_angle);
        intensities = planes.transposed();
    } else {
        if (!is_c) {
            planes.reverse();
            vertical = shifted(web.polar, -right_angle);
        }
        horizontal = planes.angles();
        intensities = planes.intensities();
    }
    const V3f size = dimensions(web.opening);
    out << fmt::format("IESNA:LM-63-2002\n[TEST] written by Interflect\nTILT=NONE\n1 {} 1 {} {} {} 2 {} {} {}\n1 1 0\n",
                       web.lamp_lumens > 0 ? web.lamp_lumens : -1, vertical.size(), horizontal.size(),
                       is_c   ? 1
                       : is_b ? 2
                              : 3,
                       size.y, size.x, size.z);
    const auto put = [&](const float* begin, std::size_t count) {
        constexpr std::size_t per_line = 10;
        for (std::size_t i = 0; i < count; ++i)
            out << fmt::format("{}{}", begin[i], i + 1 == count || i % per_line == per_line - 1 ? '\n' : ' ');
    };
    put(vertical.data(), vertical.size());
    put(horizontal.data(), horizontal.size());
    for (std::size_t i = 0; i < horizontal.size(); ++i) put(intensities.data() + i * vertical.size(), vertical.size());
}

void write_ies(const PhotometricWeb& web, const std::filesystem::path& path) {
    std::ostringstream text;
    write_ies(web, text);
    write_file(path, std::move(text).str());
}

}  // namespace interflect::detail
