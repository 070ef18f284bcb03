#include "scene_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "argument.h"
#include "interflect/geometry/polygons/add_face.h"
#include "interflect/scene/core/core.h"

namespace interflect::python {

namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int64_t, py::array::c_style>;

/// Checks arrays and collects their faults, which one exception reports.
class Arguments {
  public:
    void add(const Fault& fault) { faults_.push_back(fault); }
    /// @param name  Name of the argument, which starts the sentence.
    void add(const char* name, const std::string& expected) {
        add(Fault{.text = fmt::format("{}: {}", name, expected), .setting = name});
    }

    /// Returns an array (count, columns). For another shape or type, adds a fault and returns an empty array.
    /// @param count  Expected count, or -1 for any.
    Doubles numbers(const py::object& value, const char* name, py::ssize_t count, py::ssize_t columns) {
        return checked<Doubles>(value, name, "numbers", count, {columns});
    }
    /// Returns an array (count) if `columns` is empty, else (count, c) with c in `columns`.
    Integers integers(const py::object& value, const char* name, py::ssize_t count,
                      const std::vector<py::ssize_t>& columns) {
        const py::array array = py::array::ensure(value);
        if (!array || (array.size() > 0 && array.dtype().kind() != 'i' && array.dtype().kind() != 'u')) {
            PyErr_Clear();
            add(name, fmt::format("expected integers, found {}", kind_of(array)));
            return Integers(0);
        }
        return checked<Integers>(array.attr("astype")("int64"), name, "integers", count, columns);
    }

    void throw_faults(const std::string& name) const {
        Scene scene;
        scene.name = name;
        require_no_faults(faults_, "cannot make the scene", scene);
    }
    bool empty() const { return faults_.empty(); }

  private:
    static std::string kind_of(const py::array& array) {
        return array ? std::string(py::str(array.dtype())) : std::string("no array (rows of different lengths?)");
    }

    template <class Array>
    Array checked(const py::object& value, const char* name, const char* kind, py::ssize_t count,
                  const std::vector<py::ssize_t>& columns) {
        const Array array = Array::ensure(value);
        if (!array) {
            PyErr_Clear();
            add(name, fmt::format("expected an array of {}", kind));
            return Array(0);
        }
        const bool is_flat = columns.empty();
        const bool has_shape =
            is_flat ? array.ndim() == 1
                    : array.ndim() == 2 && std::find(columns.begin(), columns.end(), array.shape(1)) != columns.end();
        if (has_shape && (count < 0 || array.shape(0) == count)) return array;
        std::string expected = count < 0 ? "(n" : fmt::format("({}", count);
        for (std::size_t i = 0; i < columns.size(); ++i)
            expected += fmt::format("{}{}", i == 0 ? ", " : " or ", columns[i]);
        std::string found;
        for (py::ssize_t i = 0; i < array.ndim(); ++i) found += fmt::format("{}{}", i > 0 ? ", " : "", array.shape(i));
        add(name, fmt::format("expected the shape {}), found ({})", expected + (is_flat ? "," : ""), found));
        return Array(0);
    }

    std::vector<Fault> faults_;
};

/// Sets the origin and the vertices relative to it.
void place_vertices(Scene& scene, const Doubles& vertices, const Integers& faces, Arguments& arguments) {
    const auto points = vertices.unchecked<2>();
    const auto at = [&](py::ssize_t i) { return Imath::V3d(points(i, 0), points(i, 1), points(i, 2)); };
    for (py::ssize_t i = 0; i < points.shape(0); ++i)
        if (const Imath::V3d p = at(i); !is_finite(p)) {
            arguments.add({fmt::format("vertex {} is ({}, {}, {}): expected finite numbers", i, p.x, p.y, p.z),
                           fmt::format("vertex {}", i), "vertices"});
            return;
        }
    detail::FaceSample sample;
    const auto corners = faces.unchecked<2>();
    for (py::ssize_t f = 0; f < corners.shape(0); ++f) {
        if (!sample.wants_next()) continue;
        Imath::Box3d box;
        for (py::ssize_t c = 0; c < corners.shape(1); ++c)
            if (corners(f, c) >= 0 && corners(f, c) < points.shape(0)) box.extendBy(at(corners(f, c)));
        if (!box.isEmpty() && box.size().length() > 0) sample.add({box.center(), box.size().length()});
    }
    scene.origin = detail::origin_for(detail::core_of(sample.faces()));
    scene.vertices.reserve(static_cast<std::size_t>(points.shape(0)));
    for (py::ssize_t i = 0; i < points.shape(0); ++i) scene.vertices.emplace_back(V3f(at(i) - scene.origin) + V3f(0));
}

/// Returns an index per face. All are 0 for None.
std::vector<std::uint32_t> indices_of_faces(const py::object& value, const char* name, py::ssize_t faces,
                                            Arguments& arguments) {
    std::vector<std::uint32_t> result(static_cast<std::size_t>(faces), 0);
    if (value.is_none()) return result;
    const Integers given = arguments.integers(value, name, faces, {});
    for (py::ssize_t f = 0; f < given.size(); ++f) {
        const std::int64_t index = given.at(f);
        if (index < 0 || index >= none) {
            arguments.add(name, fmt::format("face {} has {}, which is no index", f, index));
            break;
        }
        result[static_cast<std::size_t>(f)] = static_cast<std::uint32_t>(index);
    }
    return result;
}

std::vector<bool> sides_of_faces(const py::object& value, py::ssize_t faces, Arguments& arguments) {
    std::vector<bool> result(static_cast<std::size_t>(faces));
    if (py::isinstance<py::bool_>(value)) {
        std::fill(result.begin(), result.end(), py::cast<bool>(value));
        return result;
    }
    const auto given = py::array::ensure(value);
    if (!given || given.ndim() != 1 || given.shape(0) != faces || given.dtype().kind() != 'b') {
        PyErr_Clear();
        arguments.add("two_sided", fmt::format("expected True, False or an array of {} booleans", faces));
        return result;
    }
    const auto flags = py::array_t<bool>(given).unchecked<1>();
    for (py::ssize_t f = 0; f < faces; ++f) result[static_cast<std::size_t>(f)] = flags(f);
    return result;
}

void add_faces(Scene& scene, const Integers& faces, const std::vector<std::uint32_t>& materials,
               const std::vector<std::uint32_t>& objects, const std::vector<bool>& two_sided, Arguments& arguments) {
    const auto corners = faces.unchecked<2>();
    for (py::ssize_t f = 0; f < corners.shape(0); ++f) {
        Patch patch;
        for (py::ssize_t c = 0; c < corners.shape(1); ++c) {
            const std::int64_t v = corners(f, c);
            if (c == 3 && (v == -1 || v == none)) continue;  // a triangle
            if (v < 0 || v >= static_cast<std::int64_t>(scene.vertices.size()))
                return arguments.add(
                    {fmt::format("face {}: vertex {} does not exist; expected below {}", f, v, scene.vertices.size()),
                     fmt::format("face {}", f), "faces"});
            patch.vertices[static_cast<std::size_t>(c)] = static_cast<std::uint32_t>(v);
        }
        const auto i = static_cast<std::size_t>(f);
        patch.material = materials[i];
        patch.object = objects[i];
        detail::add_face(scene, patch, two_sided[i] ? patch.material : none);
    }
}

/// Copies an attribute of the vertices with two or three numbers each.
template <class T>
void set_attribute(std::vector<T>& attribute, const py::object& value, const char* name, std::size_t vertices,
                   Arguments& arguments) {
    if (value.is_none()) return;
    constexpr int columns = static_cast<int>(sizeof(T) / sizeof(float));
    const Doubles given = arguments.numbers(value, name, static_cast<py::ssize_t>(vertices), columns);
    if (given.ndim() != 2) return;
    const auto numbers = given.template unchecked<2>();
    attribute.resize(vertices);
    for (py::ssize_t i = 0; i < numbers.shape(0); ++i)
        for (int c = 0; c < columns; ++c) attribute[static_cast<std::size_t>(i)][c] = static_cast<float>(numbers(i, c));
}

/// Converts a sequence of `T` or a single `T`. Returns nullopt for None. @throws TypeError naming the argument.
template <class T>
std::optional<std::vector<T>> sequence_of(const py::object& value, const char* name, const char* type) {
    if (value.is_none()) return std::nullopt;
    try {
        if (py::isinstance<py::sequence>(value)) return py::cast<std::vector<T>>(value);
        return std::vector<T>{py::cast<T>(value)};
    } catch (const py::cast_error&) {
        throw py::type_error(fmt::format("{}: expected a sequence of {}, found {}", name, type, found(value)));
    }
}

/// Replaces the parts that are not None.
void set_parts(Scene& scene, const Parts& parts) {
    if (auto materials = sequence_of<Material>(parts.materials, "materials", "Material"))
        scene.materials = std::move(*materials);
    if (auto luminaires = sequence_of<Luminaire>(parts.luminaires, "luminaires", "Luminaire"))
        scene.luminaires = std::move(*luminaires);
    if (auto views = sequence_of<View>(parts.views, "views", "View")) scene.views = std::move(*views);
    if (auto groups = sequence_of<LightGroup>(parts.light_groups, "light_groups", "LightGroup"))
        scene.light_groups = std::move(*groups);
    if (const auto textures = sequence_of<std::shared_ptr<Texture>>(parts.textures, "textures", "Texture")) {
        scene.textures.clear();
        for (const std::shared_ptr<Texture>& texture : *textures) scene.textures.push_back(*texture);
    }
}

}  // namespace

Documented scene_from_arrays_text() {
    return Documented(
               "Makes a scene from arrays, which are copied. It is validated as a whole: one exception lists all "
               "faults.",
               {{"vertices", "(n, 3) numbers, world coordinates [m]."},
                {"faces",
                 "(m, 3) or (m, 4) integers: vertices of triangles or planar convex quadrilaterals, "
                 "counter-clockwise seen from the lit side; -1 as the fourth for a triangle. Each face becomes one "
                 "patch, a two-sided face two adjacent ones."},
                {"materials", "Material, or a sequence of them."},
                {"face_materials", "(m,) integers, indices into `materials`; None: all 0."},
                {"two_sided",
                 "True, False, or (m,) booleans: whether faces have a back of the same material. Light passes "
                 "through the backs of other faces."},
                {"objects", "Names of objects, such as \"room.desk\"; the first is usually \"\"."},
                {"face_objects", "(m,) integers, indices into `objects`; None: all 0."},
                {"normals", "(n, 3) unit normals of the smooth surface at each vertex, or None."},
                {"texture_coordinates", "(n, 2), or None: (0, 0) is the lower left corner of an image."},
                {"lightmap_coordinates", "(n, 2) in [0, 1], or None."},
                {"textures", "Images that materials refer to by index."},
                {"luminaires",
                 "Light sources that are not surfaces. Their positions are relative to `origin`, which is "
                 "(0, 0, 0) unless the scene is far from it compared with its size."},
                {"views", "Views; solve() and render() find them by name."},
                {"light_groups", "Groups whose light is kept separate."},
                {"name", "Name for messages."}})
        .raises(
            "InputError: that lists every fault in `faults`: shapes, types, indices, numbers that are not finite, "
            "reflectances outside [0, 1), degenerate faces.");
}

std::shared_ptr<Scene> scene_from_arrays(const py::object& vertices, const py::object& faces,
                                         const py::object& face_materials, const py::object& two_sided,
                                         const py::object& objects, const py::object& face_objects,
                                         const py::object& normals, const py::object& texture_coordinates,
                                         const py::object& lightmap_coordinates, const Parts& parts, std::string name) {
    auto scene = std::make_shared<Scene>();
    scene->name = std::move(name);
    scene->objects = sequence_of<std::string>(objects, "objects", "names").value_or(std::vector<std::string>{""});
    set_parts(*scene, parts);

    Arguments arguments;
    const Doubles points = arguments.numbers(vertices, "vertices", -1, 3);
    const Integers corners = arguments.integers(faces, "faces", -1, {3, 4});
    if (points.ndim() == 2 && corners.ndim() == 2) {
        const py::ssize_t count = corners.shape(0);
        const auto material = indices_of_faces(face_materials, "face_materials", count, arguments);
        const auto object = indices_of_faces(face_objects, "face_objects", count, arguments);
        const auto sides = sides_of_faces(two_sided, count, arguments);
        place_vertices(*scene, points, corners, arguments);
        if (scene->vertices.size() == static_cast<std::size_t>(points.shape(0)))
            add_faces(*scene, corners, material, object, sides, arguments);
        const auto n = static_cast<std::size_t>(points.shape(0));
        set_attribute(scene->normals, normals, "normals", n, arguments);
        set_attribute(scene->texture_coordinates, texture_coordinates, "texture_coordinates", n, arguments);
        set_attribute(scene->lightmap_coordinates, lightmap_coordinates, "lightmap_coordinates", n, arguments);
        if (corners.shape(0) == 0) arguments.add("faces", "expected at least one");
    }
    for (const Fault& fault : scene_faults(*scene)) arguments.add(fault);
    arguments.throw_faults(scene->name);
    return scene;
}

std::shared_ptr<Scene> replaced(const std::shared_ptr<Scene>& scene, const Parts& parts) {
    auto copy = std::make_shared<Scene>(*scene);
    set_parts(*copy, parts);
    require_no_faults(scene_faults(*copy), "cannot make the scene", *copy);
    return copy;
}

std::shared_ptr<Texture> texture_from_array(const py::array_t<float, py::array::c_style | py::array::forcecast>& texels,
                                            const std::string& name) {
    const Image image = image_of(texels, "texels");
    auto texture = std::make_shared<Texture>(
        Texture{name, static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height), image.pixels});
    if (const std::string fault = texture_fault(*texture); !fault.empty())
        throw InputError(Fault{.text = "texture '" + name + "' " + fault, .object = name});
    return texture;
}

}  // namespace interflect::python
