#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "interflect/luminaire.h"
#include "interflect/read_options.h"
#include "interflect/warnings.h"

namespace interflect {

/// Reads measured light: IES LM-63 (.ies) or EULUMDAT (.ldt).
/// @param warnings  Gets a counted entry for each kind of oddity that is tolerated.
/// @throws InputError with file and line, where it cannot be read, and for another extension.
PhotometricWeb load_photometric_web(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// A luminaire that is placed in a scene beside what the scene's file has.
struct PlacedLuminaire {
    std::filesystem::path file;       ///< .ies or .ldt
    Imath::V3d position{0, 0, 0};     ///< In the world [m].
    std::optional<Imath::V3d> aim{};  ///< A point in the world that its nadir faces [m]; without one: down, -z.
    double turn = 0;                  ///< About its own axis, counter-clockwise as seen from above it [degrees].
    std::optional<double> lumens{};   ///< Flux of its lamps, in place of the file's; of itself where that has none.
    double maintenance = 1;           ///< Factor of its light, as lamps age and dust settles.
};

/// Its light. Without `turn` its C0 half plane holds x, or, where it faces along x, z.
/// @param web     What `placed.file` has.
/// @param origin  Scene::origin.
/// @throws InputError that names the file, for what cannot be placed so.
MeasuredLight place(const PlacedLuminaire& placed, std::shared_ptr<const PhotometricWeb> web, const Imath::V3d& origin);

}  // namespace interflect
