#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interflect/path_tracer.h"
#include "interflect/probes.h"
#include "interflect/scene.h"
#include "interflect/solve.h"
#include "interflect/warnings.h"

namespace interflect {

/// How the irradiance of a lightmap's texels is found.
enum class LightmapShading {
    smooth,  ///< Interpolated between the elements, as by Shading::smooth.
    gather,  ///< Gathered at each texel, as by measure_irradiance().
};

/// What lightmaps hold.
enum class LightmapContent {
    irradiance,  ///< H: the renderer multiplies it by the reflectance over pi, so textures stay as sharp as they are.
    radiance,    ///< L = (M + rho H) / pi, shown as it is by any renderer.
};

struct LightmapOptions {
    float texels_per_metre = 20;  ///< At least, > 0; less only on a surface that would not fit an image otherwise.
    int max_size = 4096;          ///< Of an image [texels], 64 to 16384, a multiple of 4; more images where needed.
    int gutter = 2;               ///< Around each chart, filled from its edge [texels], 1 to 64.
    LightmapShading shading = LightmapShading::smooth;
    LightmapContent content = LightmapContent::irradiance;
    int samples = 64;  ///< Gathered directions a texel, >= 2.
    std::uint64_t seed = 1;
    std::string image = ".exr";  ///< Of the images beside the file: .exr or .hdr.
    bool own_charts = false;     ///< Ignores Scene::lightmap_coordinates.
    /// Memory that it may take [bytes]: more is refused, before it is taken.
    std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max();
    bool groups = false;  ///< Adds images of each light group alone, on the same coordinates; they sum to the total.
};

/// What is exported and how.
struct ExportOptions {
    /// [stops]: a radiance of 2^-exposure becomes 1, the brightest that 8 bits hold; brighter colours are scaled to 1
    /// and keep their hue. See automatic_exposure().
    float exposure = 0;
    V3f up{0, 0, 1};                          ///< Of the scene. Formats with an up axis of their own are turned.
    std::optional<LightmapOptions> lightmap;  ///< None: the light is at the vertices of the elements.
    ProbeOptions probes;                      ///< Of formats that hold probes in place of surfaces.
    PathMonitor monitor;                      ///< Watches gathering and probes.
    Warnings* warnings = nullptr;             ///< Gets what could not be exported as it is; may be null.
};

/// A file of an export: its own, or one beside it.
struct ExportedFile {
    std::filesystem::path path;
    std::string bytes;
};

/// A format that solved scenes are exported to.
struct ExportFormat {
    const char* extension;  ///< ".glb"
    const char* name;       ///< For people: "binary glTF".
    bool takes_lightmaps;   ///< Whether ExportOptions::lightmap means something.
    /// The files at and beside `path`, the one at `path` last. Arguments are valid.
    std::vector<ExportedFile> (*make)(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                      const ExportOptions& options);
};

/// All there are; docs/export.md describes them.
extern const std::span<const ExportFormat> export_formats;

/// The format that a file name's extension asks for, in any case. @throws InputError that lists the extensions.
const ExportFormat& require_export_format(const std::filesystem::path& path);

/// Writes a solved scene in the format of the extension of `path`. Each file appears under its name when all are
/// complete; the same arguments give the same bytes.
/// @return  The files that were written.
/// @throws InputError for an unknown extension, options out of range or without meaning in the format, lightmaps of
///         light groups of a solution without groups, lightmaps beyond LightmapOptions::max_bytes, a path that
///         cannot be written, and a solution of another scene; Stopped where ExportOptions::monitor ends it before
///         each texel has some light, or each probe all of it; std::runtime_error where writing fails.
std::vector<std::filesystem::path> export_solution(const std::filesystem::path& path, const Scene& scene,
                                                   const Solution& solution, const ExportOptions& options = {});

}  // namespace interflect
