#include <fmt/format.h>

#include "argument.h"
#include "bindings.h"
#include "fields.h"
#include "interflect/export.h"
#include "interflect/load.h"
#include "interflect/prepare.h"
#include "long_work.h"

namespace interflect::python {

namespace {

constexpr std::array<std::pair<const char*, Axis>, 6> axis_names{{{"x", Axis::x},
                                                                  {"-x", Axis::minus_x},
                                                                  {"y", Axis::y},
                                                                  {"-y", Axis::minus_y},
                                                                  {"z", Axis::z},
                                                                  {"-z", Axis::minus_z}}};

Axis axis_of(const std::string& name) {
    for (const auto& [word, axis] : axis_names)
        if (word == name) return axis;
    throw InputError(fmt::format("up_axis: expected x, -x, y, -y, z or -z, found '{}'", name));
}

std::shared_ptr<Scene> load(const std::filesystem::path& path, double unit, const std::string& up_axis,
                            int curve_divisions, std::uint64_t max_patches, bool outside_files,
                            const std::vector<std::filesystem::path>& further_files,
                            const std::vector<PlacedLuminaire>& luminaires, const std::optional<Daylight>& daylight) {
    ReadOptions options;
    options.unit = unit;
    options.up_axis = axis_of(up_axis);
    options.curve_divisions = curve_divisions;
    options.max_patches = max_patches;
    options.outside_files = outside_files;
    options.further_files = further_files;
    return pure_work(0, [&] {
        return std::make_shared<Scene>(load_scene(path, options, luminaires, daylight.value_or(Daylight())));
    });
}

void bind_added_light(py::module_& m) {
    Fields<PlacedLuminaire>(m, "PlacedLuminaire", docs::PlacedLuminaire)
        .field("file", &PlacedLuminaire::file, docs::PlacedLuminaire_file)
        .field("position", &PlacedLuminaire::position, docs::PlacedLuminaire_position)
        .field("aim", &PlacedLuminaire::aim, docs::PlacedLuminaire_aim)
        .field("turn", &PlacedLuminaire::turn, docs::PlacedLuminaire_turn)
        .field("lumens", &PlacedLuminaire::lumens, docs::PlacedLuminaire_lumens)
        .field("maintenance", &PlacedLuminaire::maintenance, docs::PlacedLuminaire_maintenance)
        .field("by_top", &PlacedLuminaire::by_top, docs::PlacedLuminaire_by_top)
        .finish();
    Fields<Daylight::Sun>(m, "Sun", "The sun of Daylight.")
        .field("azimuth", &Daylight::Sun::azimuth, "Clockwise from north [degrees].")
        .field("altitude", &Daylight::Sun::altitude, docs::Daylight_Sun_altitude)
        .field("illuminance", &Daylight::Sun::illuminance, docs::Daylight_Sun_illuminance)
        .finish();
    Fields<Daylight::CieSky>(m, "CieSky", "A CIE standard sky of Daylight.")
        .field("type", &Daylight::CieSky::type, docs::Daylight_CieSky_type)
        .field("illuminance", &Daylight::CieSky::illuminance, docs::Daylight_CieSky_illuminance)
        .finish();
    Fields<Daylight::PerezSky>(m, "PerezSky", "A sky of Perez et al. 1993 of Daylight.")
        .field("direct_normal", &Daylight::PerezSky::direct_normal, "Irradiance [W/m^2].")
        .field("diffuse_horizontal", &Daylight::PerezSky::diffuse_horizontal, "Irradiance [W/m^2].")
        .finish();
    Fields<Daylight::Environment>(m, "Environment", "An image around the scene, of Daylight.")
        .field("file", &Daylight::Environment::file, docs::Daylight_Environment_file)
        .field("rotation", &Daylight::Environment::rotation, docs::Daylight_Environment_rotation)
        .field("scale", &Daylight::Environment::scale, docs::Daylight_Environment_scale)
        .finish();
    Fields<Daylight>(m, "Daylight", docs::Daylight)
        .field("sun", &Daylight::sun, "Sun, or None.")
        .field("cie_sky", &Daylight::cie_sky, "CieSky, or None.")
        .field("perez_sky", &Daylight::perez_sky, docs::Daylight_perez_sky)
        .field("environment", &Daylight::environment, "Environment, or None.")
        .field("ground_reflectance", &Daylight::ground_reflectance, docs::Daylight_ground_reflectance)
        .field("zenith", &Daylight::zenith, "Direction of the zenith; need not be normalised.")
        .finish();
}

void bind_findings(py::module_& m) {
    py::class_<Finding::Place>(m, "FindingPlace", docs::Finding_Place)
        .def_readonly("object", &Finding::Place::object, "Name of the object.")
        .def_readonly("material", &Finding::Place::material, "Name of the material.")
        .def_readonly("where", &Finding::Place::where, docs::Finding_Place_where)
        .def_property_readonly(
            "position",
            [](const Finding::Place& place) {
                return place.has_position ? std::optional(place.position) : std::nullopt;
            },
            docs::Finding_Place_position)
        .def("__repr__", [](const Finding::Place& place) {
            return fmt::format("<FindingPlace: object '{}', material '{}'{}>", place.object, place.material,
                               place.where.empty() ? "" : ", " + place.where);
        });
    py::class_<Finding>(m, "Finding", docs::Finding)
        .def_readonly("kind", &Finding::kind, docs::Finding_kind)
        .def_readonly("is_problem", &Finding::is_problem, docs::Finding_is_problem)
        .def_readonly("message", &Finding::message, docs::Finding_message)
        .def_readonly("advice", &Finding::advice, docs::Finding_advice)
        .def_readonly("count", &Finding::count, docs::Finding_count)
        .def_readonly("places", &Finding::places, docs::Finding_places)
        .def("__repr__", [](const Finding& f) { return fmt::format("<Finding {}: {}>", f.kind, f.message); });
    m.def(
        "validate",
        [](const std::shared_ptr<Scene>& scene) {
            return pure_work(0, [&] { return validate(*scene, RayCaster(*scene)); });
        },
        py::arg("scene"),
        Documented(docs::validate, {{"scene", "Scene as read by load(), before cut_at_contacts()."}})
            .returns("A list of Finding, in the order above.")
            .raises(""));
}

/// Sets `value` from a keyword, if it is given, and removes the keyword.
template <class Value>
void take(py::dict& remaining, const char* name, Value& value) {
    if (!remaining.contains(name)) return;
    value = argument<Value>(remaining[name], name);
    PyDict_DelItemString(remaining.ptr(), name);
}

/// Returns the up axis that `interflect export` would choose.
V3f up_of(const Scene& scene, Warnings& warnings) {
    if (const std::optional<UpAxis> found = find_up_axis(scene)) return found->direction();
    warnings.add("up", "the up axis is unknown: taking z; the option up chooses another");
    return {0, 0, 1};
}

LightmapContent content_of(const std::string& name) {
    if (name == "irradiance") return LightmapContent::irradiance;
    if (name == "radiance") return LightmapContent::radiance;
    if (name == "density") return LightmapContent::density;
    throw InputError(fmt::format("content: expected irradiance, radiance or density, found '{}'", name));
}

std::vector<std::filesystem::path> export_light(const SharedLight& light, const std::filesystem::path& path,
                                                bool lightmap, int threads, const py::object& progress,
                                                const py::kwargs& keywords) {
    if (is_scene_export(path)) throw InputError(path, 0, "export_scene() writes this format");
    ExportOptions options;
    LightmapOptions texels;
    py::dict remaining(keywords);
    std::string shading = label(options.bake.shading), content = "irradiance";
    std::optional<int> samples;
    // Display and orientation
    take(remaining, "exposure", options.exposure);
    Warnings warnings;
    options.warnings = &warnings;
    if (remaining.contains("up")) {
        take(remaining, "up", options.up);
    } else {
        options.up = up_of(*light->scene, warnings);
    }
    // Light of texels, vertices and probes
    take(remaining, "shading", shading);
    take(remaining, "samples", samples);
    take(remaining, "seed", options.bake.seed);
    if (remaining.contains("denoise")) {
        options.bake.denoiser = denoiser_of(remaining["denoise"]);
        PyDict_DelItemString(remaining.ptr(), "denoise");
    }
    name_library_of_pyoidn();
    options.probes.seed = options.bake.seed;
    take(remaining, "max_error", options.vertices.max_error);
    take(remaining, "min_edge", options.vertices.min_edge);
    take(remaining, "max_edge", options.vertices.max_edge);
    take(remaining, "max_triangles", options.vertices.max_triangles);
    take(remaining, "polygons", options.polygons);
    take(remaining, "spacing", options.probes.spacing);
    take(remaining, "rays", options.probes.rays);
    // Lightmaps
    if (lightmap) {
        take(remaining, "texels_per_metre", texels.texels_per_metre);
        if (remaining.contains("densities")) {
            for (const auto& [pattern, density] : remaining["densities"].cast<py::dict>())
                texels.densities.push_back({pattern.cast<std::string>(), density.cast<float>()});
            PyDict_DelItemString(remaining.ptr(), "densities");
        }
        take(remaining, "max_size", texels.max_size);
        take(remaining, "gutter", texels.gutter);
        take(remaining, "image", texels.image);
        take(remaining, "own_charts", texels.own_charts);
        take(remaining, "keep_file", texels.keep_file);
        take(remaining, "keep_lights", texels.keep_lights);
        take(remaining, "groups", texels.groups);
        take(remaining, "update", texels.update);
        take(remaining, "content", content);
        texels.content = content_of(content);
        options.lightmap = texels;
    }
    for (const auto& [name, value] : remaining)
        throw py::type_error("export: unknown option " + found(name) + (lightmap ? "" : " without lightmap=True"));
    options.bake.shading = find_shading(shading, lightmap ? &DefaultSamples::texel : &DefaultSamples::vertex);
    options.bake.samples = samples_of(samples);
    auto files = long_work(progress, threads, [&](const Monitor& monitor) {
        options.monitor = monitor;
        return export_solution(path, *light->scene, *light->solution, options);
    });
    warn(warnings, 2);
    return files;
}

}  // namespace

void bind_files(py::module_& m) {
    bind_added_light(m);
    bind_findings(m);
    m.def("load", &load, py::arg("path"), py::arg("unit"), py::arg("up_axis"), py::arg("curve_divisions"),
          py::arg("max_patches"), py::arg("outside_files"), py::arg("further_files"), py::arg("luminaires"),
          py::arg("daylight"), Documented("For interflect.load()."));
    m.def(
        "read_radiance_view", &read_radiance_view, py::arg("path"),
        Documented("Reads a view file of Radiance (.vf), with Radiance's defaults; it is named after the file.")
            .raises(
                "InputError: for an invalid file, for projections other than -vtv, shift, lift and clipping planes."));
    m.def(
        "load_photometric_web",
        [](const std::filesystem::path& path) {
            Warnings warnings;
            auto web = std::make_shared<PhotometricWeb>(load_photometric_web(path, ReadOptions(), warnings));
            warn(warnings, 1);
            return web;
        },
        py::arg("path"), Documented(docs::load_photometric_web));
    m.def(
        "cut_at_contacts",
        [](const std::shared_ptr<Scene>& scene, const std::optional<float>& min_extent) {
            if (min_extent && !(*min_extent >= 0)) throw InputError("min_extent: expected 0 m or more");
            return pure_work(0, [&] {
                const float usual = static_cast<float>(2 * default_element_size(*scene));
                return std::make_shared<Scene>(cut_at_contacts(*scene, {.min_extent = min_extent.value_or(usual)}));
            });
        },
        py::arg("scene"), py::arg("min_extent") = py::none(),
        Documented(
            docs::cut_at_contacts,
            {{"min_extent",
              "Minimum extent of connected segments [m], >= 0; smaller ones are ignored. None: twice the side of "
              "the smallest elements of a solution."}})
            .raises("InputError: for a negative extent."));
    m.def("export_solution", &export_light, py::arg("solution"), py::arg("path"), py::kw_only(),
          py::arg("lightmap") = false, py::arg("threads") = 0, py::arg("progress") = py::none(),
          Documented("For interflect.export()."));
    m.def(
        "export_exposure",
        [](const SharedLight& light, int threads) {
            return pure_work(threads, [&] { return export_exposure(*light->scene, *light->solution); });
        },
        py::arg("solution"), py::arg("threads") = 0, Documented(docs::export_exposure));
    m.def(
        "export_scene",
        [](const std::shared_ptr<Scene>& scene, const std::filesystem::path& path) {
            const SceneExport written = export_scene(path, *scene);
            warn(written.warnings, 1);
            return written.files;
        },
        py::arg("scene"), py::arg("path"),
        Documented(docs::export_scene, {{"path",
                                         "File to write: .rad (Radiance), .xml (Mitsuba 3), .pbrt (pbrt-v4) or .py "
                                         "(a script for Blender)."}})
            .returns("A list of the files that were written, as pathlib.Path."));
}

}  // namespace interflect::python
