#include <fmt/format.h>

#include "interflect/exports/files/mesh_files.h"
#include "interflect/exports/vertices/lit_polygons.h"

namespace interflect::detail {

namespace {

std::size_t max_corners(const LitPolygons& polygons) {
    std::size_t most = 0;
    for (std::size_t i = 0; i < polygons.size(); ++i)
        most = std::max<std::size_t>(most, polygons.ends[i] - polygons.begin(i));
    return most;
}

void append_position(std::string& bytes, const Scene& scene, const V3f& point) {
    for (int k = 0; k < 3; ++k)
        if (scene.origin == Imath::V3d(0))
            append_bytes(bytes, point[k]);
        else
            append_bytes(bytes, scene.origin[k] + static_cast<double>(point[k]));
}

}  // namespace

std::vector<ExportedFile> make_ply(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options) {
    VertexLight light = make_vertex_light(scene, solution, options);
    const LitPolygons polygons = options.polygons ? lit_polygons(scene, light) : lit_triangles(scene, light);
    const bool has_many_corners = max_corners(polygons) > 255;
    const char* coordinate = scene.origin == Imath::V3d(0) ? "float" : "double";
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\n"
        "comment made by Interflect {}\n"
        "comment red, green, blue: radiance [cd/m^2] * 2^{}, scaled to at most 1, as sRGB\n"
        "comment irradiance: [lm/m^2] of each channel, linear Rec. 709\n"
        "element vertex {}\nproperty {} x\nproperty {} y\nproperty {} z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "property float irradiance_red\nproperty float irradiance_green\nproperty float irradiance_blue\n"
        "element face {}\nproperty list {} uint vertex_indices\nend_header\n",
        INTERFLECT_VERSION, options.exposure, polygons.vertices.size(), coordinate, coordinate, coordinate,
        polygons.size(), has_many_corners ? "uint" : "uchar");
    for (const LitPolygons::Vertex& vertex : polygons.vertices) {
        append_position(bytes, scene, polygons.points[vertex.point]);
        for (const std::uint8_t c : display_colour(vertex.radiosity, options.exposure)) append_bytes(bytes, c);
        for (int c = 0; c < 3; ++c) append_bytes(bytes, vertex.irradiance[c]);
    }
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        const std::uint32_t count = polygons.ends[i] - polygons.begin(i);
        if (has_many_corners)
            append_bytes(bytes, count);
        else
            append_bytes(bytes, static_cast<std::uint8_t>(count));
        for (std::uint32_t c = polygons.begin(i); c < polygons.ends[i]; ++c) append_bytes(bytes, polygons.corners[c]);
    }
    return {{path, std::move(bytes)}};
}

}  // namespace interflect::detail
