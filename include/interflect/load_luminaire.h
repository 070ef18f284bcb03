#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "interflect/luminaire.h"
#include "interflect/read_options.h"
#include "interflect/warnings.h"

namespace interflect {

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
};

/// Returns the measured light at its place. Without `turn` its C0 half plane contains x, or z if the luminaire faces
/// along x.
/// @param web     Contents of `placed.file`.
/// @param origin  Scene::origin.
/// @throws InputError that names the file, for an invalid placement.
MeasuredLight place(const PlacedLuminaire& placed, std::shared_ptr<const PhotometricWeb> web, const Imath::V3d& origin);

}  // namespace interflect
