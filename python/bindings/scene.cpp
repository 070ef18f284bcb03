#include <fmt/format.h>

#include "argument.h"
#include "bindings.h"
#include "fields.h"
#include "interflect/prepare.h"
#include "interflect/scene.h"
#include "long_work.h"
#include "scene_arrays.h"

namespace interflect::python {

namespace {

using SharedScene = std::shared_ptr<Scene>;

/// Returns a function that converts an attribute of the vertices to an array, or to None if it is missing.
template <class Member>
auto vertex_array(Member Scene::*member) {
    return [member](const SharedScene& scene) -> py::object {
        if (((*scene).*member).empty()) return py::none();
        return rows<float>(scene, (*scene).*member);
    };
}

/// Returns a function that copies parts of a scene, because Python may change them.
template <class Part>
auto copies(std::vector<Part> Scene::*member) {
    return [member](const Scene& scene) -> std::vector<Part> { return scene.*member; };
}

/// Returns the index of each patch's other side, or -1.
py::array_t<std::int64_t> other_sides(const Scene& scene) {
    py::array_t<std::int64_t> result(static_cast<py::ssize_t>(scene.patches.size()));
    for (std::size_t i = 0; i < scene.patches.size(); ++i) {
        const std::uint32_t other = scene.patches[i].other_side;
        result.mutable_at(static_cast<py::ssize_t>(i)) = other == none ? -1 : static_cast<std::int64_t>(other);
    }
    return result;
}

std::string describe(const Scene& s) {
    return fmt::format("<Scene '{}': {} patches, {} materials, {} luminaires, {} views>", s.name, s.patches.size(),
                       s.materials.size(), s.luminaires.size(), s.views.size());
}

void bind_summary(py::module_& m) {
    py::class_<MaterialSummary>(m, "MaterialSummary", docs::MaterialSummary)
        .def_readonly("material", &MaterialSummary::material, docs::MaterialSummary_material)
        .def_readonly("area", &MaterialSummary::area, docs::MaterialSummary_area)
        .def_readonly("reflectance", &MaterialSummary::reflectance, docs::MaterialSummary_reflectance)
        .def_readonly("emitting_patches", &MaterialSummary::emitting_patches, docs::MaterialSummary_emitting_patches)
        .def_readonly("emitting_objects", &MaterialSummary::emitting_objects, docs::MaterialSummary_emitting_objects)
        .def_readonly("emitting_area", &MaterialSummary::emitting_area, docs::MaterialSummary_emitting_area)
        .def_readonly("power", &MaterialSummary::power, docs::MaterialSummary_power)
        .def("__repr__", [](const MaterialSummary& s) {
            return fmt::format("<MaterialSummary {}: {:.4g} m^2, {:.4g} lm or W>", s.material, s.area,
                               luminance(s.power));
        });
    py::class_<SceneSummary>(m, "SceneSummary", docs::SceneSummary)
        .def_property_readonly(
            "bounds", [](const SceneSummary& s) { return std::pair(s.bounds.min, s.bounds.max); },
            "Lowest and highest corner, in world coordinates [m].")
        .def_readonly("triangles", &SceneSummary::triangles, docs::SceneSummary_triangles)
        .def_readonly("two_sided", &SceneSummary::two_sided, docs::SceneSummary_two_sided)
        .def_readonly("area", &SceneSummary::area, docs::SceneSummary_area)
        .def_readonly("emitted_power", &SceneSummary::emitted_power, docs::SceneSummary_emitted_power)
        .def_readonly("materials", &SceneSummary::materials, docs::SceneSummary_materials)
        .def_readonly("luminaires", &SceneSummary::luminaires, docs::SceneSummary_luminaires)
        .def("__repr__", [](const SceneSummary& s) {
            return fmt::format("<SceneSummary: {} materials, {:.4g} m^2, {:.4g} lm or W>", s.materials.size(), s.area,
                               luminance(s.emitted_power));
        });
    m.def(
        "summarise",
        [](const SharedScene& scene) { return pure_work(0, [&] { return summarise(*scene, RayCaster(*scene)); }); },
        py::arg("scene"), Documented(docs::summarise).raises("InputError: for a scene with faults."));
}

}  // namespace

View view_of(const Scene& scene, const py::object& view) {
    if (py::isinstance<View>(view)) return py::cast<View>(view);
    if (py::isinstance<py::str>(view)) return find_view(scene, argument<std::string>(view, "view"));
    throw py::type_error("view: expected a View, the name of a view of the scene, or None, found " + found(view));
}

View view_or_overview(const Scene& scene, const RayCaster& ray_caster, const py::object& view, int threads) {
    if (!view.is_none()) return view_of(scene, view);
    if (!scene.views.empty()) return scene.views.front();
    return pure_work(threads, [&] { return overview(scene, ray_caster); });
}

void bind_scene_parts(py::module_& m) {
    const auto texture = [](std::uint32_t Material::*member) {
        return [member](const Material& material) -> std::optional<std::uint32_t> {
            return material.*member == none ? std::nullopt : std::optional(material.*member);
        };
    };
    const auto set_texture = [](std::uint32_t Material::*member) {
        return [member](Material& material, std::optional<std::uint32_t> index) {
            material.*member = index.value_or(none);
        };
    };
    Fields<Material>(m, "Material", docs::Material)
        .field("name", &Material::name, "Name.")
        .field("reflectance", &Material::reflectance, docs::Material_reflectance)
        .field("exitance", &Material::exitance, docs::Material_exitance)
        .field("transmittance", &Material::transmittance, docs::Material_transmittance)
        .field("specular_reflectance", &Material::specular_reflectance, docs::Material_specular_reflectance)
        .field("reflectance_texture", texture(&Material::reflectance_texture),
               set_texture(&Material::reflectance_texture),
               "Index of a texture that multiplies the reflectance, or None.")
        .field("exitance_texture", texture(&Material::exitance_texture), set_texture(&Material::exitance_texture),
               "Index of a texture that multiplies the exitance, or None.")
        .field("transmittance_texture", texture(&Material::transmittance_texture),
               set_texture(&Material::transmittance_texture),
               "Index of a texture that multiplies the transmittance, or None.")
        .finish();
    Fields<View>(m, "View", docs::View)
        .field("name", &View::name, "Name.")
        .field("eye", &View::eye, docs::View_eye)
        .field("look_at", &View::look_at, docs::View_look_at)
        .field("up", &View::up, docs::View_up)
        .field("fov", &View::fov, docs::View_fov)
        .field("extent", &View::extent, docs::View_extent)
        .finish();
    Fields<LightGroup>(m, "LightGroup", docs::LightGroup)
        .field("name", &LightGroup::name, "Name.")
        .field("pattern", &LightGroup::pattern, docs::LightGroup_pattern)
        .finish();
    py::class_<Texture, std::shared_ptr<Texture>>(m, "Texture", docs::Texture)
        .def(py::init(&texture_from_array), py::arg("texels"), py::arg("name") = "texture",
             Documented("Makes a texture from an array, which is copied.",
                        {{"texels", "(height, width, 3): linear Rec. 709, >= 0, row 0 at the top."},
                         {"name", "Name for messages."}})
                 .raises("InputError: for another shape, for texels that are negative or not finite, and for a side of "
                         "more than 16384 texels."))
        .def_readonly("name", &Texture::name, docs::Texture_name)
        .def_property_readonly(
            "texels",
            [](const std::shared_ptr<Texture>& t) {
                const auto width = static_cast<py::ssize_t>(t->width), number = py::ssize_t{sizeof(float)};
                return read_only(std::shared_ptr<const void>(t), reinterpret_cast<const float*>(t->texels.data()),
                                 {static_cast<py::ssize_t>(t->height), width, 3},
                                 {width * 3 * number, 3 * number, number});
            },
            "(height, width, 3) float32: linear Rec. 709, >= 0, row 0 at the top.")
        .def("__repr__",
             [](const Texture& t) { return fmt::format("<Texture '{}': {} x {}>", t.name, t.width, t.height); });
}

void bind_scene(py::module_& m) {
    py::class_<Scene, SharedScene>(m, "Scene", docs::Scene)
        .def(py::init([](const py::object& vertices, const py::object& faces, const py::object& materials,
                         const py::object& face_materials, const py::object& two_sided, const py::object& objects,
                         const py::object& face_objects, const py::object& normals,
                         const py::object& texture_coordinates, const py::object& lightmap_coordinates,
                         const py::object& textures, const py::object& luminaires, const py::object& views,
                         const py::object& light_groups, std::string name) {
                 return scene_from_arrays(vertices, faces, face_materials, two_sided, objects, face_objects, normals,
                                          texture_coordinates, lightmap_coordinates,
                                          {materials, luminaires, views, light_groups, textures}, std::move(name));
             }),
             py::arg("vertices"), py::arg("faces"), py::arg("materials"), py::kw_only(),
             py::arg("face_materials") = py::none(), py::arg("two_sided") = false, py::arg("objects") = py::none(),
             py::arg("face_objects") = py::none(), py::arg("normals") = py::none(),
             py::arg("texture_coordinates") = py::none(), py::arg("lightmap_coordinates") = py::none(),
             py::arg("textures") = py::tuple(), py::arg("luminaires") = py::tuple(), py::arg("views") = py::tuple(),
             py::arg("light_groups") = py::tuple(), py::arg("name") = "arrays", scene_from_arrays_text())
        .def(
            "replace",
            [](const SharedScene& s, const py::object& materials, const py::object& luminaires, const py::object& views,
               const py::object& light_groups, const py::object& textures) {
                return replaced(s, {materials, luminaires, views, light_groups, textures});
            },
            py::kw_only(), py::arg("materials") = py::none(), py::arg("luminaires") = py::none(),
            py::arg("views") = py::none(), py::arg("light_groups") = py::none(), py::arg("textures") = py::none(),
            Documented("Copies the scene, with other materials, luminaires, views, light groups or textures. The copy "
                       "shares no memory with the scene.",
                       {{"materials", "Sequence of Material; None: unchanged, as for the others."},
                        {"luminaires", "Sequence of Luminaire."},
                        {"views", "Sequence of View."},
                        {"light_groups", "Sequence of LightGroup."},
                        {"textures", "Sequence of Texture."}})
                .raises("InputError: that lists every fault of the result."))
        .def_readonly("name", &Scene::name, docs::Scene_name)
        .def_readonly("origin", &Scene::origin, docs::Scene_origin)
        .def_property_readonly(
            "vertices", [](const SharedScene& s) { return rows<float>(s, s->vertices); },
            "(n, 3) float32, read-only, without a copy. Relative to `origin` [m]; unused vertices are ignored.")
        .def_property_readonly(
            "faces",
            [](const SharedScene& s) {
                static const Patch nothing{};
                const Patch& first = s->patches.empty() ? nothing : s->patches.front();
                return read_only(s, first.vertices.data(), {static_cast<py::ssize_t>(s->patches.size()), 4},
                                 {sizeof(Patch), sizeof(std::uint32_t)});
            },
            "(m, 4) uint32, read-only, without a copy: vertices of each patch, counter-clockwise seen from the lit "
            "side; the last is 4294967295 (interflect.none) for a triangle. A patch is one side of a face; the patches "
            "of a "
            "two-sided face are adjacent, the front first.")
        .def_property_readonly(
            "face_materials",
            [](const SharedScene& s) { return column<std::uint32_t>(s, s->patches, &Patch::material); },
            "(m,) uint32, read-only: material of each patch, an index into `materials`.")
        .def_property_readonly(
            "face_objects", [](const SharedScene& s) { return column<std::uint32_t>(s, s->patches, &Patch::object); },
            "(m,) uint32, read-only: object of each patch, an index into `objects`.")
        .def_property_readonly(
            "other_sides", [](const SharedScene& s) { return other_sides(*s); },
            "(m,) int64: the patch on the back of each face, or -1.")
        .def_property_readonly("normals", vertex_array(&Scene::normals),
                               "(n, 3) float32, read-only: unit normal of the smooth surface at every vertex, of "
                               "arbitrary sign; (0, 0, 0) at "
                               "vertices without one. None if no vertex has one. Rays meet the flat patches; normals "
                               "decide where shading is "
                               "smooth and how it varies within a patch.")
        .def_property_readonly(
            "texture_coordinates", vertex_array(&Scene::texture_coordinates),
            "(n, 2) float32, read-only: (u, v) of every vertex; (0, 0) is the lower left corner of an "
            "image. None if no patch is textured.")
        .def_property_readonly(
            "lightmap_coordinates", vertex_array(&Scene::lightmap_coordinates),
            "(n, 2) float32, read-only: (u, v) in [0, 1] of every vertex in the lightmap of its object, "
            "NaN without; (0, 0) is the lower left corner. None without any.")
        .def_property_readonly("materials", copies(&Scene::materials), "Copies of the materials; see replace().")
        .def_property_readonly(
            "textures",
            [](const SharedScene& s) {
                std::vector<std::shared_ptr<Texture>> textures;
                for (Texture& t : s->textures) textures.emplace_back(s, &t);
                return textures;
            },
            "Images of the materials, without a copy.")
        .def_property_readonly("luminaires", copies(&Scene::luminaires),
                               (std::string(docs::Scene_luminaires) + " Copies; see replace().").c_str())
        .def_property_readonly("light_groups", copies(&Scene::light_groups),
                               (std::string(docs::Scene_light_groups) + " Copies; see replace().").c_str())
        .def_readonly("objects", &Scene::objects, docs::Scene_objects)
        .def_property_readonly("views", copies(&Scene::views), "Named views. Copies; see replace().")
        .def_readonly("files", &Scene::files, docs::Scene_files)
        .def_property_readonly(
            "warnings", [](const SharedScene& s) { return sentences(s->warnings); },
            "Unsupported features of the file, one sentence each.")
        .def("__copy__", [](const SharedScene& s) { return s; })  // it does not change
        .def("__deepcopy__", [](const SharedScene& s, const py::dict&) { return s; })
        .def("__repr__", [](const SharedScene& s) { return describe(*s); });
    m.attr("none") = none;
    m.def(
        "groups_by_name", [](const SharedScene& s) { return groups_by_name(*s); }, py::arg("scene"),
        Documented(docs::groups_by_name));
    bind_summary(m);
    m.def(
        "overview", [](const SharedScene& s) { return pure_work(0, [&] { return overview(*s, RayCaster(*s)); }); },
        py::arg("scene"),
        Documented("Returns a view for a scene without views. It shows a lit room or, for scenes without one, the "
                   "scene from an upper corner.")
            .raises("InputError: for a scene with faults."));
}

}  // namespace interflect::python
