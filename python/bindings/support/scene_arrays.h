/// Scenes from arrays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bindings.h"

namespace interflect::python {

Documented scene_from_arrays_text();

using Textures = std::vector<std::shared_ptr<Texture>>;

/// As scene_from_arrays_text() says.
std::shared_ptr<Scene> scene_from_arrays(
    const py::object& vertices, const py::object& faces, const py::object& materials, const py::object& face_materials,
    const py::object& two_sided, const py::object& objects, const py::object& face_objects, const py::object& normals,
    const py::object& texture_coordinates, const py::object& lightmap_coordinates, const Textures& textures,
    std::vector<Luminaire> luminaires, std::vector<View> views, std::vector<LightGroup> light_groups, std::string name);

/// Copy with other parts; None keeps a part. @throws InputError that lists every fault.
std::shared_ptr<Scene> replaced(const std::shared_ptr<Scene>& scene,
                                const std::optional<std::vector<Material>>& materials,
                                const std::optional<std::vector<Luminaire>>& luminaires,
                                const std::optional<std::vector<View>>& views,
                                const std::optional<std::vector<LightGroup>>& light_groups,
                                const std::optional<Textures>& textures);

/// @param texels  (height, width, 3). @throws InputError for another shape and a texture_fault().
std::shared_ptr<Texture> texture_from_array(const py::array_t<float, py::array::c_style | py::array::forcecast>& texels,
                                            const std::string& name);

}  // namespace interflect::python
