#include "interflect/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interflect/base/files/crc32.h"
#include "interflect/core.h"
#include "interflect/formats/gltf/gltf.h"
#include "interflect/formats/mesh/obj/obj.h"
#include "interflect/formats/mesh/ply/ply.h"
#include "interflect/formats/mesh/stl.h"
#include "interflect/formats/mesh/vs3.h"
#include "interflect/formats/mgf/mgf.h"
#include "interflect/formats/rad/rad.h"
#include "interflect/formats/reading/checked_options.h"
#include "interflect/formats/text/extension.h"
#include "interflect/formats/text/text_file.h"
#include "interflect/formats/view_files.h"
#include "interflect/scene/core/core.h"

namespace interflect {

using namespace detail;

namespace fs = std::filesystem;

namespace {

struct Format {
    std::string_view extension;
    Scene (*read)(const fs::path&, const ReadOptions&);
};

constexpr Format formats[] = {{".mgf", read_mgf}, {".glb", read_gltf}, {".gltf", read_gltf},
                              {".obj", read_obj}, {".ply", read_ply},  {".rad", read_rad},
                              {".mat", read_rad}, {".stl", read_stl},  {".vs3", read_vs3}};

const Format& format_of(const fs::path& path) {
    const std::string extension = lower_case_extension(path);
    std::string known;
    for (const Format& format : formats) {
        if (format.extension == extension) return format;
        known += (known.empty() ? "" : ", ") + std::string(format.extension);
    }
    throw InputError(path, 0,
                     fmt::format("no scene format is known by the extension '{}'; known: {}", extension, known));
}

/// @throws InputError unless all files are Radiance files.
void require_joinable(const fs::path& first, const std::vector<fs::path>& further) {
    if (further.empty()) return;
    const auto require_rad = [](const fs::path& path) {
        if (format_of(path).read != read_rad)
            throw InputError(path, 0,
                             "several files are read as one scene only if all are Radiance's (.rad, .mat): give one "
                             "file, and join the parts in the program that wrote them");
    };
    require_rad(first);
    for (const fs::path& path : further) {
        require_regular_file(path);
        require_rad(path);
    }
}

/// Reads the view list of the first file that has one.
void read_views(Scene& scene, std::vector<fs::path> files) {
    for (fs::path& file : files) file = view_list_path(file);
    std::error_code ignored;
    const auto list =
        std::find_if(files.begin(), files.end(), [&](const fs::path& f) { return fs::exists(f, ignored); });
    if (list == files.end()) return;
    scene.views = read_view_list(*list);
    scene.files.push_back(list->string());
}

bool emits(const Scene& scene) {
    const auto shines = [](const Luminaire& luminaire) { return largest_channel(rating(luminaire)) > 0; };
    if (std::any_of(scene.luminaires.begin(), scene.luminaires.end(), shines)) return true;
    return std::any_of(scene.patches.begin(), scene.patches.end(), [&](const Patch& patch) {
        return largest_channel(scene.materials[patch.material].exitance) > 0;
    });
}

/// Diagonals that indicate a wrong unit [m].
constexpr float implausibly_large = 2000, implausibly_small = 0.05f;

void warn_of_size(Scene& scene) {
    const float size = core_bounds(scene).size().length();
    if (size > implausibly_large || size < implausibly_small)
        scene.warnings.add("implausible-size",
                           fmt::format("the scene is {:.3g} m across: the file may be in another unit (unit)", size));
}

void add_luminaires(Scene& scene, std::span<const PlacedLuminaire> luminaires, const ReadOptions& options) {
    std::map<fs::path, std::shared_ptr<const PhotometricWeb>> webs;
    for (const PlacedLuminaire& placed : luminaires) {
        auto& web = webs[placed.file];
        if (!web) {
            web = std::make_shared<PhotometricWeb>(load_photometric_web(placed.file, options, scene.warnings));
            scene.files.push_back(placed.file.string());
        }
        Luminaire luminaire{fmt::format("{}-{}", placed.file.stem().string(), scene.luminaires.size() + 1), 0,
                            place(placed, web, scene.origin)};
        if (const std::string fault = luminaire_fault(luminaire); !fault.empty())
            throw InputError(placed.file, 0, "this luminaire " + fault);
        if (placed.maintenance > 1)
            scene.warnings.add("maintenance-factor",
                               fmt::format("the maintenance factor {:g} makes light stronger; usual ones are at most 1",
                                           placed.maintenance),
                               placed.file.string());
        scene.luminaires.push_back(std::move(luminaire));
    }
}

std::vector<std::uint32_t> checksums_of(const std::vector<std::string>& files) {
    std::vector<std::uint32_t> checksums;
    checksums.reserve(files.size());
    for (const std::string& file : files) checksums.push_back(crc32_of_file(file));
    return checksums;
}

}  // namespace

Scene load_scene(const fs::path& path, const ReadOptions& options, std::span<const PlacedLuminaire> luminaires,
                 const Daylight& added) {
    require_regular_file(path);
    require_joinable(path, options.further_files);
    Scene scene = format_of(path).read(path, checked(options));
    warn_of_size(scene);
    add_luminaires(scene, luminaires, options);
    add_daylight(scene, added);
    std::vector<fs::path> files = options.further_files;
    files.insert(files.begin(), path);
    read_views(scene, std::move(files));
    scene.file_checksums = checksums_of(scene.files);
    if (!emits(scene)) scene.warnings.add("no-light", "the scene emits no light: all pictures will be black");
    return scene;
}

}  // namespace interflect
