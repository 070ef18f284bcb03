#include "interflect/export.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "interflect/base/files/pending_file.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/files/mesh_files.h"
#include "interflect/exports/files/write_files.h"
#include "interflect/exports/lit_gltf.h"
#include "interflect/exports/probe_files.h"
#include "interflect/formats/text/extension.h"
#include "interflect/render/pictures/camera_samples.h"

namespace interflect {

using namespace detail;

namespace fs = std::filesystem;

namespace {

constexpr std::array formats{
    ExportFormat{".glb", "binary glTF", true, make_glb},
    ExportFormat{".gltf", "glTF", true, make_gltf},
    ExportFormat{".ply", "PLY", false, make_ply},
    ExportFormat{".obj", "Wavefront OBJ", false, make_obj},
    ExportFormat{".vtu", "VTK unstructured grid", false, make_vtu},
    ExportFormat{".vtkhdf", "VTK unstructured grid in HDF5", false, make_vtkhdf},
    ExportFormat{".hdf", "the same, for ParaView 5.11 and older", false, make_vtkhdf},
    ExportFormat{".json", "irradiance probes", false, make_probes_json},
    ExportFormat{".exr", "irradiance probes as an image", false, make_probes_exr},
};

void require_usable(const LightmapOptions& options) {
    const auto require = [](bool holds, const std::string& fault) {
        if (!holds) throw InputError("lightmap: " + fault);
    };
    require(options.texels_per_metre > 0 && std::isfinite(options.texels_per_metre),
            fmt::format("texels_per_metre is {}, expected a number above 0", options.texels_per_metre));
    for (const auto& [pattern, density] : options.densities)
        require(density >= 0 && std::isfinite(density),
                fmt::format("the density of '{}' is {}, expected a number above 0, or 0 for no lightmap", pattern,
                            density));
    require(options.max_size >= 64 && options.max_size <= 16384 && options.max_size % 4 == 0,
            fmt::format("max_size is {}, expected a multiple of 4 from 64 to 16384", options.max_size));
    require(options.gutter >= 1 && options.gutter <= 64, fmt::format("gutter is {}, expected 1 to 64", options.gutter));
    require(options.image == ".exr" || options.image == ".hdr",
            fmt::format("image is '{}', expected .exr or .hdr", options.image));
    require(options.content != LightmapContent::density || (options.update.empty() && !options.groups),
            "content is density, expected irradiance or radiance for an update and for light groups");
    require(options.update.empty() || options.image == ".exr",
            "image is .hdr, expected .exr for an update, because it keeps the texels of the images");
}

void require_usable(const VertexOptions& options) {
    const auto require = [](bool holds, const std::string& fault) {
        if (!holds) throw InputError("vertices: " + fault);
    };
    require(options.max_error > 0, fmt::format("max_error is {}, expected a number above 0", options.max_error));
    require(options.min_edge > 0, fmt::format("min_edge is {}, expected a number above 0", options.min_edge));
    require(options.max_edge >= options.min_edge,
            fmt::format("max_edge is {}, expected at least min_edge, {}", options.max_edge, options.min_edge));
    require(options.max_triangles >= 1, fmt::format("max_triangles is {}, expected at least 1", options.max_triangles));
}

void require_usable(const ExportFormat& format, const ExportOptions& options) {
    if (!std::isfinite(options.exposure))
        throw InputError(fmt::format("exposure is {}, expected a finite number of stops", options.exposure));
    const float length = options.up.length();
    if (!(length > 0 && std::isfinite(length))) throw InputError("up has no direction");
    require_samples(options.bake.shading, options.lightmap ? &DefaultSamples::texel : &DefaultSamples::vertex);
    if (const int samples = options.bake.samples; samples != 0 && samples < 2)
        throw InputError(fmt::format("samples is {}, expected at least 2", samples));
    if (!options.lightmap) return require_usable(options.vertices);
    if (!format.takes_lightmaps)
        throw InputError(fmt::format("{} ({}) takes no lightmaps", format.name, format.extension));
    require_usable(*options.lightmap);
}

}  // namespace

const std::span<const ExportFormat> export_formats(formats);

const ExportFormat& require_export_format(const fs::path& path) {
    const std::string extension = lower_case_extension(path);
    std::string known;
    for (const ExportFormat& format : export_formats) {
        if (extension == format.extension) return format;
        known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", format.extension, format.name);
    }
    for (const char* scene_extension : scene_export_extensions) known += fmt::format(", {}", scene_extension);
    throw InputError(path, 0, "expected one of the extensions " + known);
}

std::vector<fs::path> export_solution(const fs::path& path, const Scene& scene, const Solution& solution,
                                      const ExportOptions& options) {
    const ExportFormat& format = require_export_format(path);
    require_usable(format, options);
    require_no_faults(scene_faults(scene), "cannot export", scene);
    const bool needs_light = !options.lightmap || options.lightmap->content != LightmapContent::density;
    if (needs_light || solution.forest) {
        solution.forest->require_made_for(scene);
        require_values_of_elements(*solution.forest, solution.irradiance.size(), "irradiance");
    }
    if (options.lightmap && options.lightmap->groups && solution.groups.empty())
        throw InputError("lightmaps of light groups: the solution has no groups; solve the scene with light groups");
    const PendingFile can_be_written(path);  // throws before the computation if the path cannot be written

    return write_files(format.make(path, scene, solution, options));
}

}  // namespace interflect
