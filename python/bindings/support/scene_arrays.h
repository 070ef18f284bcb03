/// Makes scenes from NumPy arrays.
#pragma once

#include <memory>
#include <string>

#include "bindings.h"

namespace interflect::python {

Documented scene_from_arrays_text();

/// Arguments for parts of a scene: sequences, or None.
struct Parts {
    py::object materials, luminaires, views, light_groups, textures;
};

/// Makes a scene as scene_from_arrays_text() describes.
std::shared_ptr<Scene> scene_from_arrays(const py::object& vertices, const py::object& faces,
                                         const py::object& face_materials, const py::object& two_sided,
                                         const py::object& objects, const py::object& face_objects,
                                         const py::object& normals, const py::object& texture_coordinates,
                                         const py::object& lightmap_coordinates, const Parts& parts, std::string name);

/// Returns a copy with other parts. @throws InputError that lists every fault.
std::shared_ptr<Scene> replaced(const std::shared_ptr<Scene>& scene, const Parts& parts);

/// @param texels  (height, width, 3). @throws InputError for another shape and a texture_fault().
std::shared_ptr<Texture> texture_from_array(const py::array_t<float, py::array::c_style | py::array::forcecast>& texels,
                                            const std::string& name);

}  // namespace interflect::python
