#include "tests/support/scenes/scenes.h"

#include <cstdlib>
#include <fstream>
#include <random>
#include <stdexcept>

namespace interflect::testing_support {

namespace fs = std::filesystem;

fs::path repository() { return INTERFLECT_SOURCE_FOLDER; }

fs::path real_scenes() {
    if (const char* folder = std::getenv("INTERFLECT_SCENES")) return folder;
    return repository().parent_path() / "shared" / "scenes";
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "interflect-test-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

fs::path TemporaryFolder::write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
}

PatchIndex add_rectangle(Scene& scene, V3f corner, V3f u, V3f v, std::uint32_t material, int nu, int nv,
                         bool two_sided) {
    const auto first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
    const PatchIndex first_patch(scene.patches.size());
    if (scene.objects.empty()) scene.objects.emplace_back();
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i)
            scene.vertices.push_back(corner + u * (static_cast<float>(i) / static_cast<float>(nu)) +
                                     v * (static_cast<float>(j) / static_cast<float>(nv)));
    const auto vertex = [&](int i, int j) { return first_vertex + static_cast<std::uint32_t>(j * (nu + 1) + i); };
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            const PatchIndex index(scene.patches.size());
            Patch front;
            front.vertices = {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)};
            front.material = material;
            if (two_sided) front.other_side = PatchIndex(index + 1);
            scene.patches.push_back(front);
            if (!two_sided) continue;
            Patch back = front;
            back.vertices = {front.vertices[0], front.vertices[3], front.vertices[2], front.vertices[1]};
            back.other_side = PatchIndex(index);
            scene.patches.push_back(back);
        }
    return first_patch;
}

void add_box(Scene& scene, V3f low, V3f high, std::uint32_t material) {
    const V3f size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    add_rectangle(scene, low, y, x, material);
    add_rectangle(scene, low + z, x, y, material);
    add_rectangle(scene, low, x, z, material);
    add_rectangle(scene, low + y, z, x, material);
    add_rectangle(scene, low, z, y, material);
    add_rectangle(scene, low + x, y, z, material);
}

std::map<std::pair<std::uint32_t, std::uint32_t>, double> face_areas(const Scene& scene) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> areas;
    for (const Patch& patch : scene.patches) {
        const auto x = [&](std::size_t i) { return Imath::V3d(scene.vertices[patch.vertices[i]]); };
        double area = 0;
        if (patch.is_triangle())
            area = (x(1) - x(0)).cross(x(2) - x(0)).length() / 2;
        else
            area = (x(1) - x(0)).cross(x(3) - x(0)).length() / 2 + (x(3) - x(2)).cross(x(1) - x(2)).length() / 2;
        areas[{patch.material, patch.object}] += area;
    }
    return areas;
}

std::uint32_t add_material(Scene& scene, Rgb reflectance, Rgb exitance) {
    scene.materials.push_back({"material " + std::to_string(scene.materials.size()), reflectance, exitance});
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

Scene closed_box(V3f s, int n, const std::vector<Material>& materials) {
    Scene scene;
    scene.name = "closed box";
    scene.materials = materials;
    const V3f x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z), o(0, 0, 0);
    const auto wall = [&](std::uint32_t w, V3f corner, V3f u, V3f v) {
        add_rectangle(scene, corner, u, v, materials.size() == 1 ? 0 : w, n, n);
    };
    wall(0, o, y, z);
    wall(1, x, z, y);
    wall(2, o, z, x);
    wall(3, y, x, z);
    wall(4, o, x, y);
    wall(5, z, y, x);
    return scene;
}

}  // namespace interflect::testing_support
