#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "interflect/scene.h"

namespace interflect::testing_support {

/// Returns the root of the repository.
std::filesystem::path repository();

/// Returns the folder of real test scenes: the environment variable INTERFLECT_SCENES, or shared/scenes beside the
/// repository.
std::filesystem::path real_scenes();

/// A folder that is removed with its contents at the end of the scope.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, const std::string& text) const;

  private:
    std::filesystem::path path_;
};

/// Adds the parallelogram corner, corner + u, corner + u + v, corner + v, lit on the side of u x v, divided into nu x
/// nv patches. Returns the index of the first patch (row by row in v).
PatchIndex add_rectangle(Scene& scene, V3f corner, V3f u, V3f v, std::uint32_t material, int nu = 1, int nv = 1,
                         bool two_sided = false);

/// Adds a closed box of six one-sided faces that face outwards, with their own vertices.
void add_box(Scene& scene, V3f low, V3f high, std::uint32_t material);

/// Computes the area of each face [m^2], by material and object; quadrilaterals count as the two triangles used for
/// intersection.
std::map<std::pair<std::uint32_t, std::uint32_t>, double> face_areas(const Scene& scene);

std::uint32_t add_material(Scene& scene, Rgb reflectance, Rgb exitance);

/// Makes a closed box from (0,0,0) to `size`, lit inside, each wall divided into n x n patches of one-sided faces.
/// Walls in order: x = 0, x = size.x, y = 0, y = size.y, z = 0, z = size.z; materials[w] for wall w (one for all if
/// size 1).
Scene closed_box(V3f size, int n, const std::vector<Material>& materials);

}  // namespace interflect::testing_support
