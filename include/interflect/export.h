/// @file
/// Writes a solved scene for other programs (lit glTF, lightmaps, meshes, probes), or a scene for other renderers.
#pragma once

#include <ImathVec.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interflect/core.h"
#include "interflect/denoise.h"
#include "interflect/measure.h"
#include "interflect/scene.h"
#include "interflect/shading.h"
#include "interflect/solve.h"

namespace interflect {

/// Light of texels and vertices.
struct BakeOptions {
    Shading shading = Shading::hybrid;  ///< `smooth`, `hybrid` or `gather`.
    /// Number of points per texel or vertex at which direct light is sampled, or of gathered directions, >= 2. 0: the
    /// number in default_samples. Ignored by Shading::smooth.
    int samples = 0;
    std::uint64_t seed = 1;
    std::optional<Denoiser> denoiser = Denoiser::own;  ///< Filter of lightmaps by Shading::hybrid; empty: none.
};

/// Triangulation for light in vertices, which is finer where direct light varies. Ignored by Shading::smooth.
struct VertexOptions {
    /// Maximum error of interpolated direct light, relative to the irradiance there or, if it is larger, the mean
    /// irradiance; > 0.
    float max_error = 0.05f;
    float min_edge = 0.02f;       ///< Shorter edges are not divided [m], > 0.
    float max_edge = 0.25f;       ///< Longer edges are divided, by up to half of max_triangles [m], >= min_edge.
    int max_triangles = 200'000;  ///< Approximate maximum, >= 1; faces of the scene are never merged.
};

/// Quantity stored in lightmaps.
enum class LightmapContent {
    irradiance,  ///< H: the renderer multiplies it by the reflectance over pi, which keeps textures sharp.
    radiance,    ///< L = (M + rho H) / pi, which any renderer can show directly.
    /// No light: squares of 8 x 8 texels on unlit materials, whose colour shows the resolution: violet for a quarter of
    /// LightmapOptions::texels_per_metre or less, teal for equality, yellow for four times that or more.
    density,
};

/// Resolution of lightmaps on some surfaces.
struct TexelDensity {
    std::string pattern;     ///< Pattern of object names (see LightGroup) or material names.
    float texels_per_metre;  ///< >= 0; 0: no lightmap, possible only in the scene's own glTF file.
};

/// Resolution of a lightmap on the surfaces of an object where it is lowest, relative to the requested one.
struct ObjectDensity {
    std::string object;
    float requested, obtained;  ///< [texels/m]
};

/// Size of a lightmap.
struct LightmapSummary {
    std::vector<Imath::V2i> sizes;         ///< Size of each image [texels].
    std::vector<ObjectDensity> densities;  ///< One entry per object with a lightmap.
};

struct LightmapOptions {
    float texels_per_metre = 20;  ///< Minimum resolution, > 0; lower only on surfaces that would not fit into an image.
    std::vector<TexelDensity> densities;  ///< Exceptions; the first matching one applies.
    int max_size = 4096;                  ///< Maximum side of an image [texels], 64 to 16384, a multiple of 4.
    int gutter = 2;                       ///< Margin of each chart, filled from its edge [texels], 1 to 64.
    LightmapContent content = LightmapContent::irradiance;
    std::string image = ".exr";  ///< Format of the images beside the file: .exr or .hdr.
    bool own_charts = false;     ///< Whether Scene::lightmap_coordinates are ignored.
    /// Whether the light of a scene from a glTF file is added to that file (Scene::files), which keeps its nodes,
    /// meshes and materials. Else the faces of the scene are written as a new file; also, with a warning, if the file
    /// is missing or has changed since it was read.
    bool keep_file = true;
    bool keep_lights = false;  ///< Whether a file that is kept keeps its light sources, whose light is in the lightmap.
    /// Memory limit [bytes], checked before allocation.
    std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max();
    bool groups =
        false;  ///< Whether to add images of each light group, with the same coordinates; they sum to the total.
    /// Patterns of names of objects (see LightGroup) or materials whose light is computed anew in an existing file, in
    /// all charts that contain such surfaces; all other texels keep their bytes. The file is an earlier export of the
    /// same layout with the same `content`, `groups` and light groups, and `image` is .exr. Its exposure and scale
    /// stay; ExportOptions::exposure is ignored. Empty: all light is computed.
    std::vector<std::string> update;
};

/// Options of export_solution().
struct ExportOptions {
    /// Exposure [stops]: a radiance of 2^-exposure becomes 1, the brightest 8-bit value. Brighter colours are scaled to
    /// 1, which preserves their hue. See export_exposure().
    float exposure = 0;
    V3f up{0, 0, 1};   ///< Up axis of the scene, which is rotated for formats with a fixed up axis.
    BakeOptions bake;  ///< For .glb, .gltf, .ply and .obj.
    std::optional<LightmapOptions> lightmap;  ///< nullopt: the light is stored in vertices.
    VertexOptions vertices;                   ///< For light in vertices.
    /// Whether .ply and .obj files contain convex polygons of up to dozens of corners in place of triangles. Some
    /// readers refuse or skip such polygons.
    bool polygons = false;
    ProbeOptions probes;                 ///< For formats that store probes instead of surfaces.
    Monitor monitor;                     ///< Monitors the light of texels, vertices and probes.
    Warnings* warnings = nullptr;        ///< Receives features that could not be exported unchanged; may be null.
    LightmapSummary* summary = nullptr;  ///< Receives the size of the lightmap; may be null.
};

/// A file of an export.
struct ExportedFile {
    std::filesystem::path path;
    std::string bytes;
};

/// An export format for solved scenes.
struct ExportFormat {
    const char* extension;  ///< Such as ".glb".
    const char* name;       ///< Display name, such as "binary glTF".
    bool takes_lightmaps;   ///< Whether ExportOptions::lightmap is supported.
    /// Creates the files at and beside `path`, the one at `path` last. Arguments are valid.
    std::vector<ExportedFile> (*make)(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                      const ExportOptions& options);
};

/// All export formats; docs/files/export.md describes them.
extern const std::span<const ExportFormat> export_formats;

/// Returns the export format for a file name's extension, ignoring case. @throws InputError that lists the extensions.
const ExportFormat& require_export_format(const std::filesystem::path& path);

/// Writes a solved scene in the format of the extension of `path`. Files appear under their names when all are
/// complete. The same arguments give the same bytes. LightmapContent::density needs no light: `solution` may be
/// Solution() if the scene's own glTF file is kept.
/// @return  The files that were written.
/// @throws InputError for an unknown extension, options out of range or unsupported by the format, lightmaps of light
///         groups for a solution without groups, lightmaps beyond LightmapOptions::max_bytes, an update of a file that
///         is missing or has another layout, a path that cannot be written, and a solution of another scene; Stopped if
///         ExportOptions::monitor ends it before each texel and vertex has some light, or each probe all of it;
///         std::runtime_error if writing fails.
std::vector<std::filesystem::path> export_solution(const std::filesystem::path& path, const Scene& scene,
                                                   const Solution& solution, const ExportOptions& options = {});

/// Exposure for a natural impression of an exported scene [stops]: automatic_exposure() of its first view. Without a
/// view, the logarithmic mean of the luminance of reflecting surfaces, by area, becomes 0.2. The darkest surfaces,
/// which together reflect 1% of the light, are ignored: the outside of a lit building. 0 without light.
/// @throws InputError for a solution of another scene.
float export_exposure(const Scene& scene, const Solution& solution);

struct SceneExportOptions {
    int width = 1280, height = 720;  ///< Size of the pictures [pixels], >= 1.
    int samples = 256;               ///< Samples per pixel, >= 1; Radiance has no such setting.
    std::vector<View> views;         ///< Cameras; if empty, the views of the scene, or overview().
};

/// Files written, and warnings about unsupported features.
struct SceneExport {
    std::vector<std::filesystem::path> files;
    Warnings warnings;
};

/// Extensions of export_scene(): .rad (Radiance), .xml (Mitsuba 3), .pbrt (pbrt-v4), .py (a script for Blender).
extern const std::span<const char* const> scene_export_extensions;

/// Returns whether export_scene() supports the extension of this path.
bool is_scene_export(const std::filesystem::path& path);

/// Writes a scene for another renderer: faces with diffuse materials and images, emitters, light sources, skies as an
/// image, views as cameras. Referenced files are written beside it. Radiance is M / pi. Photometric values are kept,
/// except for Radiance, which needs them divided by 179 lm/W. Coordinates are relative to Scene::origin.
/// @throws InputError for an unknown extension, an option out of range and a path that cannot be written.
SceneExport export_scene(const std::filesystem::path& path, const Scene& scene, const SceneExportOptions& options = {});

}  // namespace interflect
