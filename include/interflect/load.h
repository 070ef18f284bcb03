/// @file
/// Reads scenes and measured light from files; adds luminaires and daylight.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/light_sources.h"
#include "interflect/scene.h"

namespace interflect {

/// A direction along an axis.
enum class Axis { x, minus_x, y, minus_y, z, minus_z };

/// Options and limits of readers. A file beyond a limit causes an InputError that names the option, before memory is
/// allocated.
struct ReadOptions {
    /// Length of the file's unit [m], in [1e-9, 1e9]: scales all coordinates, for every format. Views in a separate
    /// file (load_scene()) are in metres.
    double unit = 1;
    Axis up_axis = Axis::z;  ///< Up axis of the file, which is rotated to z.
    /// Flat pieces per quarter circle of a curved surface, 1 to 1000. Pieces of an emitting surface have its exact
    /// area.
    int curve_divisions = 4;
    std::uint64_t max_patches = 50'000'000;  ///< Total patches, at most 4 * 10^9; also bounds the copies of MGF arrays.
    int max_include_depth = 32;              ///< Nested include files; 0 refuses every include.
    int max_nesting = 1000;                  ///< Nested transforms, and nested objects.
    std::size_t max_line_length = 1 << 16;   ///< Characters, including continuation lines.
    /// Twice the limit of MGF's own parser. The time for crossing outlines grows with its square.
    std::size_t max_face_vertices = 1024;
    std::size_t max_name_length = 256;            ///< Characters of one name; four times that for a dotted object name.
    std::size_t max_photometric_bytes = 1 << 24;  ///< Size of one photometric file (.ies, .ldt).
    std::uint64_t max_model_bytes = std::uint64_t{1} << 32;  ///< Mesh file, with referenced and unpacked data.
    std::size_t max_json_bytes = 1 << 26;                    ///< Size of the text of a glTF file.
    /// Radiance files that are read after the scene's file, in any folder. They see the modifiers of earlier files, as
    /// in `oconv materials.rad room.rad`. Other formats take none.
    std::vector<std::filesystem::path> further_files{};
    bool outside_files = false;  ///< Whether a glTF, OBJ or Radiance file may refer to files outside its folder.
    std::size_t max_photometric_values = 1'000'000;  ///< In one file; steps of 0.1 by 1 degree give 650,000.
};

/// Reads measured light: IES LM-63 (.ies) or EULUMDAT (.ldt).
/// @param warnings  Receives a counted entry for each kind of tolerated deviation.
/// @throws InputError with file and line for invalid files, and for another extension.
PhotometricWeb load_photometric_web(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// A luminaire to add to a scene.
struct PlacedLuminaire {
    std::filesystem::path file;       ///< .ies or .ldt
    Imath::V3d position{0, 0, 0};     ///< In world coordinates [m].
    std::optional<Imath::V3d> aim{};  ///< World point that its nadir faces [m]; nullopt: down, -z.
    double turn = 0;  ///< Rotation about its axis, counter-clockwise seen from above the luminaire [degrees].
    std::optional<double> lumens{};  ///< Lamp flux, instead of the file's; luminaire flux if the file has none.
    double maintenance = 1;          ///< Maintenance factor of its light, for ageing lamps and dust.
    /// Whether `position` is on a ceiling, 1 mm above the top of the opening; else it is the opening's middle.
    bool by_top = false;
};

/// Returns the measured light at its place. Without `turn` its C0 half plane contains x, or z if the luminaire faces
/// along x.
/// @param web     Contents of `placed.file`.
/// @param origin  Scene::origin.
/// @throws InputError that names the file, for an invalid placement.
MeasuredLight place(const PlacedLuminaire& placed, std::shared_ptr<const PhotometricWeb> web, const Imath::V3d& origin);

/// Daylight to add to a scene. Azimuths are clockwise from north, seen from above: 90 is east. North is the world's y
/// axis, or -z if y is close to the zenith.
struct Daylight {
    struct Sun {
        double azimuth = 180, altitude = 45;  ///< Centre of the disc [degrees]; altitude in (0, 90].
        std::optional<double> illuminance{};  ///< Illuminance of a surface facing the sun [lx].
    };
    struct CieSky {
        int type = 1;                         ///< Type of cie_standard_sky().
        std::optional<double> illuminance{};  ///< Horizontal, of the sky alone [lx].
    };
    struct PerezSky {
        double direct_normal = 0, diffuse_horizontal = 0;  ///< Irradiances [W/m^2].
    };
    struct Environment {
        std::filesystem::path file;  ///< .exr or .hdr.
        double rotation = 0;         ///< Azimuth of the middle of the image [degrees].
        double scale = 1;            ///< Factor of its radiance.
    };
    std::optional<Sun> sun{};
    std::optional<CieSky> cie_sky{};
    std::optional<PerezSky> perez_sky{};  ///< Replaces cie_sky; also determines the illuminance of the sun.
    std::optional<Environment> environment{};
    double ground_reflectance = 0;  ///< Reflectance of an unobstructed ground below the horizon, lit by sky and sun.
    V3f zenith{0, 0, 1};
};

/// Default illuminances [lx] (IES RP-21, 1984; Gillette et al. 1984): horizontal, of the sky; and of a surface facing
/// the sun. With h the altitude of the sun:
///     CIE types 11 to 15, clear:            800 + 15500 sin^1/2 h,   127500 exp(-0.21 / sin h)
///     CIE types 6 to 10, partly cloudy:     300 + 45000 sin h,       127500 exp(-0.80 / sin h)
///     CIE types 1 to 5 and 16, overcast:    300 + 21000 sin h,       0
/// and 10000 for an overcast sky without a sun's altitude.
double usual_sky_illuminance(int cie_type, std::optional<double> sun_altitude);
double usual_sun_illuminance(int cie_type, double sun_altitude);

/// Adds daylight to a scene, as lights named by type and index among all lights: "sun-3", "sky-4", "environment-5".
/// Omits a sun of 0 lx. Without a sky, the default illuminance of the sun is the one for a clear sky.
/// @throws InputError for values out of range, a sky that requires a missing sun, an unreadable file, and more than
///         max_skies in the resulting scene.
void add_daylight(Scene& scene, const Daylight& added);

/// Reads a scene in the format of the file name's extension (.mgf, .gltf, .glb, .obj, .ply, .rad, .stl, .vs3), and
/// named views from an optional file beside it: office.views.json for office.mgf. The result has no scene_faults(). A
/// scene without light gets the warning "no-light".
/// @param luminaires  Added to the scene; each is named by its file and its index among the scene's lights: "lamp-3".
/// @param added       Added after them, as by add_daylight().
/// @throws InputError for an unknown extension, as the readers do, and for a scene of more than options.max_patches.
Scene load_scene(const std::filesystem::path& path, const ReadOptions& options = {},
                 std::span<const PlacedLuminaire> luminaires = {}, const Daylight& added = {});

/// Path of the optional file with the views of a scene: /a/office.views.json for /a/office.mgf.
std::filesystem::path view_list_path(const std::filesystem::path& scene_path);

/// Reads a Radiance view (rvu options), named after the file, with Radiance's defaults; later lines override. Ignores
/// -vh, which follows from the picture's shape.
/// @throws InputError, also for projections other than -vtv, shift, lift or clipping planes.
View read_radiance_view(const std::filesystem::path& path);

}  // namespace interflect
