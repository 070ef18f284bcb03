#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "bindings.h"
#include "fields.h"
#include "interflect/measure.h"
#include "long_work.h"

namespace interflect::python {

namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

struct Measurement {
    std::vector<MeasuredIrradiance> points;
};
using SharedMeasurement = std::shared_ptr<Measurement>;

/// Returns rows of three numbers; a single row may stand for all. @throws InputError for another shape.
std::vector<Imath::V3d> vectors_of(const Doubles& array, const std::string& name, py::ssize_t count = -1) {
    const bool is_single = array.ndim() == 1 && array.shape(0) == 3;
    const bool is_list = array.ndim() == 2 && array.shape(1) == 3;
    if (!is_single && !(is_list && (count < 0 || array.shape(0) == count)))
        throw InputError(
            fmt::format("{}: expected the shape ({}, 3) or (3,)", name, count < 0 ? "n" : std::to_string(count)));
    const py::ssize_t rows = is_single ? 1 : array.shape(0);
    std::vector<Imath::V3d> result;
    for (py::ssize_t i = 0; i < rows; ++i) {
        const double* p = array.data() + 3 * i;
        result.emplace_back(p[0], p[1], p[2]);
    }
    if (is_single && count > 1) result.resize(static_cast<std::size_t>(count), result.front());
    return result;
}

Receiver receiver_of(const std::string& name) {
    if (name == "planar") return Receiver::planar;
    if (name == "cylindrical") return Receiver::cylindrical;
    if (name == "semicylindrical") return Receiver::semicylindrical;
    throw InputError(fmt::format("receiver: expected planar, cylindrical or semicylindrical, found '{}'", name));
}

SharedMeasurement measure(const SharedLight& light, const Doubles& points, const Doubles& normals,
                          const std::string& receiver, const Doubles& axes, const MeasuringOptions& options,
                          int threads, const py::object& progress) {
    const std::vector<Imath::V3d> positions = vectors_of(points, "points");
    const auto count = static_cast<py::ssize_t>(positions.size());
    const std::vector<Imath::V3d> normal = vectors_of(normals, "normals", count),
                                  axis = vectors_of(axes, "axes", count);
    const Receiver kind = receiver_of(receiver);
    std::vector<MeasuringPoint> places;
    for (std::size_t i = 0; i < positions.size(); ++i)
        places.push_back({positions[i], V3f(normal[i]), kind, V3f(axis[i])});
    return long_work(progress, threads, [&](const Monitor& monitor) {
        return std::make_shared<Measurement>(Measurement{
            measure_irradiance(*light->scene, light->solution.get(), *light->ray_caster, places, options, monitor)});
    });
}

/// Returns a function that computes an array with a value for each point.
template <class Value>
auto each_point(const Value& value) {
    return [value](const Measurement& m) {
        py::array_t<float> result(static_cast<py::ssize_t>(m.points.size()));
        for (std::size_t i = 0; i < m.points.size(); ++i)
            result.mutable_at(static_cast<py::ssize_t>(i)) = value(m.points[i]);
        return result;
    };
}

py::array_t<float> irradiances(const Measurement& m) {
    py::array_t<float> result({static_cast<py::ssize_t>(m.points.size()), py::ssize_t{3}});
    float* next = result.mutable_data();
    for (const MeasuredIrradiance& point : m.points)
        for (int c = 0; c < 3; ++c) *next++ = point.sum()[c];
    return result;
}

py::array_t<double> points_of(const MeasuringGrid& grid) {
    py::array_t<double> result({static_cast<py::ssize_t>(grid.points.size()), py::ssize_t{3}});
    double* next = result.mutable_data();
    for (const Imath::V3d& point : grid.points)
        for (int c = 0; c < 3; ++c) *next++ = point[c];
    return result;
}

void bind_measuring_options(py::module_& m) {
    using Options = MeasuringOptions;
    Fields<Options>(m, "MeasuringOptions", docs::MeasuringOptions)
        .field(
            "shading", [](const Options& o) { return label(o.shading); },
            [](Options& o, const std::string& name) { o.shading = find_shading(name, &DefaultSamples::point); },
            docs::MeasuringOptions_shading)
        .field(
            "samples", [](const Options& o) { return optional_samples(o.samples); },
            [](Options& o, const std::optional<int>& samples) { o.samples = samples_of(samples); },
            docs::MeasuringOptions_samples)
        .field("until", &Options::until, docs::MeasuringOptions_until)
        .field("seed", &Options::seed, "The same seed gives the same bits for any number of threads.")
        .finish();
}

void bind_grids(py::module_& m) {
    py::class_<PlanarArea>(m, "PlanarArea", docs::PlanarArea)
        .def_readonly("name", &PlanarArea::name, docs::PlanarArea_name)
        .def_readonly("normal", &PlanarArea::normal, docs::PlanarArea_normal)
        .def_property_readonly(
            "patches",
            [](const PlanarArea& a) { return std::vector<std::uint32_t>(a.patches.begin(), a.patches.end()); },
            docs::PlanarArea_patches)
        .def_readonly("area", &PlanarArea::area, docs::PlanarArea_area)
        .def("__repr__", [](const PlanarArea& a) {
            return fmt::format("<PlanarArea '{}': {} faces, {:.4g} m^2>", a.name, a.patches.size(), a.area);
        });
    py::class_<MeasuringGrid>(m, "MeasuringGrid", docs::MeasuringGrid)
        .def_readonly("name", &MeasuringGrid::name, "Name of the area.")
        .def_property_readonly("points", &points_of, "(n, 3) float64: world coordinates [m]; for an area row by row.")
        .def_readonly("normal", &MeasuringGrid::normal, docs::MeasuringGrid_normal)
        .def_readonly("columns", &MeasuringGrid::columns, docs::MeasuringGrid_columns)
        .def_readonly("rows", &MeasuringGrid::rows, docs::MeasuringGrid_rows)
        .def_readonly("column_spacing", &MeasuringGrid::column_spacing, docs::MeasuringGrid_column_spacing)
        .def_readonly("row_spacing", &MeasuringGrid::row_spacing, docs::MeasuringGrid_row_spacing)
        .def_readonly("corner", &MeasuringGrid::corner, docs::MeasuringGrid_corner)
        .def_readonly("along_row", &MeasuringGrid::along_row, "Unit vector from cell to cell.")
        .def_readonly("along_column", &MeasuringGrid::along_column, "Unit vector from row to row.")
        .def_readonly("cells", &MeasuringGrid::cells, docs::MeasuringGrid_cells)
        .def_readonly("enclosed", &MeasuringGrid::enclosed, "Number of points inside furniture, which are left out.")
        .def("__repr__", [](const MeasuringGrid& g) {
            return fmt::format("<MeasuringGrid '{}': {} points>", g.name, g.points.size());
        });
    const auto scene = py::arg("scene"), object = py::arg("object");
    constexpr auto name_of_object = "Name of an object of the scene, such as \"room.desk\".";
    m.def("find_surface", &find_surface, scene, object, py::arg("facing") = py::none(),
          Documented(docs::find_surface, {{"object", name_of_object}}));
    m.def("find_top", &find_top, scene, object, Documented(docs::find_top, {{"object", name_of_object}}));
    m.def("find_floor", &find_floor, scene, py::arg("height") = 0.75, Documented(docs::find_floor));
    m.def(
        "grid_spacing",
        [](double length, double width) {
            if (!(length > 0 && width > 0))
                throw InputError("an area without length and width: expected more than 0 m");
            return grid_spacing(length, width);
        },
        py::arg("length"), py::arg("width"),
        Documented(docs::grid_spacing).raises("InputError: for a side that is not positive."));
    m.def(
        "area_grid",
        [](const Scene& s, const PlanarArea& area, const std::optional<double>& spacing, double boundary,
           const std::optional<double>& height) {
            return pure_work(0, [&] {
                return without_enclosed_points(s, RayCaster(s), area_grid(s, area, {spacing, boundary}, height));
            });
        },
        scene, py::arg("area"), py::arg("spacing") = py::none(), py::arg("boundary") = 0.0,
        py::arg("height") = py::none(),
        Documented(docs::area_grid, {{"area", "Result of find_surface(), find_top() or find_floor()."},
                                     {"spacing", "Maximum point distance [m], > 0; None: grid_spacing() of the area."},
                                     {"boundary", docs::GridOptions_boundary}})
            .returns(
                "A MeasuringGrid without the points that lie inside furniture and other solids, where no light can "
                "arrive; `enclosed` is their number."));
    m.def("line_grid", &line_grid, py::arg("a"), py::arg("b"), py::arg("count"),
          Documented(docs::line_grid, {{"a", "First point, in world coordinates [m]."},
                                       {"b", "Last point, in world coordinates [m]."},
                                       {"count", "Number of points."}}));
}

void bind_glare(py::module_& m) {
    py::class_<GlareSource>(m, "GlareSource", docs::GlareSource)
        .def_readonly("name", &GlareSource::name, docs::GlareSource_name)
        .def_readonly("luminance", &GlareSource::luminance, docs::GlareSource_luminance)
        .def_readonly("solid_angle", &GlareSource::solid_angle, docs::GlareSource_solid_angle)
        .def_readonly("position_index", &GlareSource::position_index, docs::GlareSource_position_index)
        .def_readonly("glare", &GlareSource::glare, docs::GlareSource_glare)
        .def_readonly("is_rated", &GlareSource::is_rated, docs::GlareSource_is_rated)
        .def("__repr__", [](const GlareSource& s) {
            return fmt::format("<GlareSource '{}': {:.4g} cd/m^2, {:.3g} sr>", s.name, s.luminance, s.solid_angle);
        });
    py::class_<GlareRating>(m, "GlareRating", docs::GlareRating)
        .def_readonly("ugr", &GlareRating::ugr, docs::GlareRating_ugr)
        .def_readonly("standard_error", &GlareRating::standard_error, docs::GlareRating_standard_error)
        .def_readonly("background_luminance", &GlareRating::background_luminance,
                      docs::GlareRating_background_luminance)
        .def_readonly("sources", &GlareRating::sources, docs::GlareRating_sources)
        .def("__repr__", [](const GlareRating& r) {
            return fmt::format("<GlareRating: UGR {:.1f}, {} sources>", r.ugr, r.sources.size());
        });
    m.def(
        "rate_glare",
        [](const SharedLight& light, const Doubles& eyes, const Doubles& lines_of_sight,
           const std::optional<int>& samples, std::uint64_t seed, int threads, const py::object& progress) {
            const std::vector<Imath::V3d> eye = vectors_of(eyes, "eyes");
            const auto sight = vectors_of(lines_of_sight, "lines_of_sight", static_cast<py::ssize_t>(eye.size()));
            std::vector<Observer> observers;
            for (std::size_t i = 0; i < eye.size(); ++i) observers.push_back({eye[i], V3f(sight[i])});
            return long_work(progress, threads, [&](const Monitor& monitor) {
                return rate_glare(*light->scene, light->solution.get(), *light->ray_caster, observers,
                                  {.samples = samples_of(samples), .seed = seed}, monitor);
            });
        },
        py::arg("solution"), py::arg("eyes"), py::arg("lines_of_sight"), py::kw_only(), py::arg("samples") = py::none(),
        py::arg("seed") = MeasuringOptions().seed, py::arg("threads") = 0, py::arg("progress") = py::none(),
        Documented(docs::rate_glare,
                   {{"solution", "Result of solve()."},
                    {"eyes", "(n, 3), or (3,): positions of the observers, in world coordinates [m]."},
                    {"lines_of_sight", "(n, 3), or (3,) for all: directions, which need not be normalised."},
                    {"samples", "Gathered directions per observer, >= 2; None: the default of probe()."}})
            .returns("A list with the rating of each observer.")
            .raises("InputError: for other shapes, and for a line of sight without direction."));
}

}  // namespace

void bind_measurements(py::module_& m) {
    py::class_<IlluminanceSummary>(m, "IlluminanceSummary", docs::IlluminanceSummary)
        .def_readonly("points", &IlluminanceSummary::points, "Number of points.")
        .def_readonly("mean", &IlluminanceSummary::mean, "Mean [lx].")
        .def_readonly("min", &IlluminanceSummary::min, "Minimum [lx].")
        .def_readonly("max", &IlluminanceSummary::max, "Maximum [lx].")
        .def_readonly("mean_error", &IlluminanceSummary::mean_error, docs::IlluminanceSummary_mean_error)
        .def_readonly("min_error", &IlluminanceSummary::min_error, docs::IlluminanceSummary_min_error)
        .def_property_readonly("uniformity", &IlluminanceSummary::uniformity, docs::IlluminanceSummary_uniformity.text)
        .def_property_readonly("diversity", &IlluminanceSummary::diversity, docs::IlluminanceSummary_diversity.text)
        .def("__repr__", [](const IlluminanceSummary& s) {
            return fmt::format("<IlluminanceSummary: {} points, mean {:.4g} lx, min {:.4g} lx, max {:.4g} lx>",
                               s.points, s.mean, s.min, s.max);
        });
    py::class_<Measurement, SharedMeasurement>(m, "Measurement",
                                               "Irradiance at points, one row per point [lux = lm/m^2, or W/m^2].")
        .def_property_readonly("irradiance", &irradiances, "(n, 3) float32: `direct` plus `indirect`.")
        .def_property_readonly(
            "direct",
            [](const SharedMeasurement& s) { return column<float>(s, s->points, &MeasuredIrradiance::direct, 3); },
            "(n, 3) float32: light received straight from the sources.")
        .def_property_readonly(
            "indirect",
            [](const SharedMeasurement& s) { return column<float>(s, s->points, &MeasuredIrradiance::indirect, 3); },
            "(n, 3) float32: light reflected at least once.")
        .def_property_readonly(
            "standard_error",
            [](const SharedMeasurement& s) {
                return column<float>(s, s->points, &MeasuredIrradiance::standard_error, 3);
            },
            array_text("(n, 3) float32", docs::MeasuredIrradiance_standard_error).c_str())
        .def_property_readonly("illuminance", each_point([](const MeasuredIrradiance& p) { return p.illuminance(); }),
                               "(n,) float32 [lux].")
        .def_property_readonly("illuminance_error",
                               each_point([](const MeasuredIrradiance& p) { return p.illuminance_error(); }),
                               "(n,) float32: standard error of `illuminance` from gathering alone [lux].")
        .def(
            "summary", [](const Measurement& s) { return summarise(s.points); },
            Documented("Computes the mean, the extremes and the uniformity of `illuminance`."))
        .def("__len__", [](const Measurement& s) { return s.points.size(); })
        .def("__repr__", [](const Measurement& s) { return fmt::format("<Measurement: {} points>", s.points.size()); });
    m.def("probe", &measure, py::arg("solution"), py::arg("points"), py::arg("normals"), py::arg("receiver"),
          py::arg("axes"), py::arg("options"), py::arg("threads"), py::arg("progress"),
          Documented("For interflect.probe()."));
    bind_measuring_options(m);
    bind_grids(m);
    bind_glare(m);
}

}  // namespace interflect::python
