#include <fmt/format.h>

#include "bindings.h"
#include "interflect/image/image_codecs.h"
#include "interflect/image/srgb.h"
#include "interflect/metrics/metrics.h"
#include "interflect/render.h"
#include "long_work.h"

namespace interflect::python {

namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using SharedTracing = std::shared_ptr<PathTracing>;

/// Scene and ray caster of a solution, or of a scene.
struct Place {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const RayCaster> ray_caster;
    std::shared_ptr<const Solution> solution;
};

Place place_of(const py::object& lit) {
    if (py::isinstance<Light>(lit)) {
        const auto light = py::cast<SharedLight>(lit);
        return {light->scene, light->ray_caster, light->solution};
    }
    const auto scene = py::cast<std::shared_ptr<Scene>>(lit);
    const py::gil_scoped_release released;
    return {scene, std::make_shared<const RayCaster>(*scene), nullptr};
}

py::array_t<float> render_elements(const SharedLight& light, const py::object& view, int width, int height, int samples,
                                   bool is_flat, bool irradiance, float crease_angle, std::uint64_t seed, int threads,
                                   const py::object& progress) {
    const View camera = view_of(*light->scene, view);
    const RenderOptions options{.width = width,
                                .height = height,
                                .samples = samples,
                                .shading = is_flat ? Shading::flat : Shading::smooth,
                                .irradiance = irradiance,
                                .smoothing = {crease_angle},
                                .seed = seed};
    return array_of(long_work(progress, threads, [&](const Monitor& monitor) {
        return render(*light->scene, *light->solution, *light->ray_caster, camera, options, monitor).image;
    }));
}

SharedTracing trace(const py::object& lit, const std::string& shading, const py::object& view, int width, int height,
                    int samples, double until, int max_samples, double time, bool irradiance, bool mirrors,
                    int light_walks, std::uint64_t seed, int threads, const py::object& progress) {
    const Place place = place_of(lit);
    const View camera = view_of(*place.scene, view);
    const PathOptions options{.width = width,
                              .height = height,
                              .samples = samples,
                              .max_samples = max_samples,
                              .until = until,
                              .time = time,
                              .quantity = irradiance ? PathQuantity::irradiance : PathQuantity::radiance,
                              .mirrors = mirrors,
                              .light_walks = light_walks,
                              .seed = seed};
    return long_work(progress, threads, [&](const Monitor& monitor) {
        const auto draw = [&]() -> PathTracing {
            if (shading == "path") return trace_paths(*place.scene, *place.ray_caster, camera, options, monitor);
            if (shading == "instant") return render_instant(*place.scene, *place.ray_caster, camera, options, monitor);
            const auto from_solution = shading == "gather" ? gather : render_hybrid;
            return from_solution(*place.scene, *place.solution, *place.ray_caster, camera, options, monitor);
        };
        return std::make_shared<PathTracing>(draw());
    });
}

/// Image that the tracing keeps alive, without a copy.
py::array image_of_tracing(const SharedTracing& owner, const Image& image) {
    constexpr py::ssize_t number = sizeof(float);
    const auto width = static_cast<py::ssize_t>(image.width);
    return read_only(owner, reinterpret_cast<const float*>(image.pixels.data()), {image.height, width, 3},
                     {width * 3 * number, 3 * number, number});
}

py::dict layers_of(const SharedTracing& tracing) {
    const PictureLayers& l = tracing->layers;
    py::dict layers;
    for (const auto& [name, image] : {std::pair{"emitted", &l.emitted},
                                      {"direct", &l.reflected.direct},
                                      {"indirect", &l.reflected.indirect},
                                      {"albedo", &l.albedo},
                                      {"normal", &l.normal},
                                      {"position", &l.position}})
        layers[name] = image_of_tracing(tracing, *image);
    const auto width = static_cast<py::ssize_t>(tracing->image.width);
    for (const auto& [name, values] : {std::pair{"depth", &l.depth},
                                       {"level", &l.level},
                                       {"direct_variance", &l.reflected.direct_variance},
                                       {"indirect_variance", &l.reflected.indirect_variance}})
        if (!values->empty())
            layers[name] = read_only(tracing, values->data(), {tracing->image.height, width},
                                     {width * static_cast<py::ssize_t>(sizeof(float)), sizeof(float)});
    return layers;
}

constexpr std::array<std::pair<const char*, Tonemap>, 7> curves{{{"srgb", Tonemap::srgb},
                                                                 {"reinhard", Tonemap::reinhard},
                                                                 {"filmic", Tonemap::filmic},
                                                                 {"agx", Tonemap::agx},
                                                                 {"ward", Tonemap::ward},
                                                                 {"tumblin", Tonemap::tumblin},
                                                                 {"ferwerda", Tonemap::ferwerda}}};

Tonemap curve_of(const std::string& name) {
    std::string known;
    for (const auto& [word, curve] : curves) {
        if (word == name) return curve;
        known += (known.empty() ? "" : ", ") + std::string(word);
    }
    throw InputError(fmt::format("curve: expected one of {}, found '{}'", known, name));
}

/// @param exposure  [stops], or None: automatic, for operators of absolute luminance 0.
Image display_values(const Floats& picture, const std::optional<float>& exposure, const std::string& curve,
                     float display_luminance) {
    const Image image = image_of(picture, "image");
    const Tonemap tonemap = curve_of(curve);
    const float automatic = is_absolute(tonemap) ? 0 : automatic_exposure(image);
    return tone_map(image, exposure.value_or(automatic), tonemap, display_luminance);
}

/// Encodes display values as sRGB (height, width, 3); pixels that are not finite are magenta, as in files.
py::array_t<std::uint8_t> display_bytes(const Image& mapped) {
    py::array_t<std::uint8_t> bytes({mapped.height, mapped.width, 3});
    std::uint8_t* next = bytes.mutable_data();
    for (const Rgb& pixel : mapped.pixels) {
        const Rgb visible = is_finite(pixel) ? pixel : Rgb(1, 0, 1);
        for (int c = 0; c < 3; ++c) *next++ = detail::srgb_byte(visible[c]);
    }
    return bytes;
}

void bind_tracing(py::module_& m) {
    py::class_<PathTracing, SharedTracing>(m, "PathTracing", docs::PathTracing)
        .def_property_readonly(
            "image", [](const SharedTracing& t) { return image_of_tracing(t, t->image); }, docs::PathTracing_image)
        .def_property_readonly(
            "standard_error", [](const SharedTracing& t) { return image_of_tracing(t, t->standard_error); },
            docs::PathTracing_standard_error)
        .def_property_readonly("layers", &layers_of, docs::PictureLayers)
        .def_readonly("relative_error", &PathTracing::relative_error, docs::PathTracing_relative_error)
        .def_readonly("rays", &PathTracing::rays, docs::PathTracing_rays)
        .def_readonly("paths", &PathTracing::paths, "Number of paths.")
        .def_readonly("non_finite_pixels", &PathTracing::non_finite_pixels, docs::PathTracing_non_finite_pixels)
        .def(
            "denoise",
            [](const SharedTracing& t) {
                return array_of(long_work(py::none(), 0, [&](const Monitor&) { return denoise(t->layers); }));
            },
            docs::denoise)
        .def("__repr__", [](const PathTracing& t) {
            return fmt::format("<PathTracing: {} x {}, {} paths, relative error {:.3g}>", t.image.width, t.image.height,
                               t.paths, t.relative_error);
        });
}

void bind_differences(py::module_& m) {
    using detail::BlockDifference, detail::ImageDifference;
    py::class_<BlockDifference>(m, "BlockDifference", "Difference of luminances averaged over square blocks.")
        .def_readonly("block", &BlockDifference::block, "Side of a block [pixels].")
        .def_readonly("relative_rmse", &BlockDifference::relative_rmse, "Relative root mean square error.")
        .def_readonly("trimmed_relative_rmse", &BlockDifference::trimmed_relative_rmse,
                      "Without the worst 1% of blocks.");
    py::class_<ImageDifference, std::shared_ptr<ImageDifference>>(m, "ImageDifference", "Image minus reference.")
        .def_readonly("ratio_of_means", &ImageDifference::ratio_of_means, "Mean luminance: image / reference.")
        .def_readonly("rmse", &ImageDifference::rmse, "sqrt(mean of (a - b)^2) [unit of the images].")
        .def_readonly("relative_mse", &ImageDifference::relative_mse,
                      "Mean of (a - b)^2 / (b^2 + (0.01 m)^2), m the mean luminance of b.")
        .def_readonly("maximum", &ImageDifference::maximum, "Largest |a - b| [unit of the images].")
        .def_readonly("perceptual_distance", &ImageDifference::perceptual_distance,
                      "First model of Rushmeier et al. 1995.")
        .def_readonly("flip", &ImageDifference::flip, "Mean of `flip_map` (Andersson et al. 2020).")
        .def_readonly("blocks", &ImageDifference::blocks, "For blocks of 1, 5 and 9 pixels.")
        .def_readonly("non_finite_pixels", &ImageDifference::non_finite_pixels, "If > 0, measures are NaN.")
        .def_property_readonly(
            "flip_map", [](const ImageDifference& d) { return array_of(d.flip_map); },
            "Visible difference of each pixel, 0 to 1, (height, width, 3).")
        .def("__repr__", [](const ImageDifference& d) {
            return fmt::format("<ImageDifference: relative_mse {:.4g}, ratio_of_means {:.4g}, flip {:.4g}>",
                               d.relative_mse, d.ratio_of_means, d.flip);
        });
}

}  // namespace

py::array_t<float> array_of(Image image) {
    auto* kept = new Image(std::move(image));
    const py::capsule owner(kept, [](void* p) { delete static_cast<Image*>(p); });
    return py::array_t<float>(
        {static_cast<py::ssize_t>(kept->height), static_cast<py::ssize_t>(kept->width), py::ssize_t{3}},
        reinterpret_cast<const float*>(kept->pixels.data()), owner);
}

Image image_of(const Floats& array, const std::string& name) {
    if (array.ndim() != 3 || array.shape(2) != 3 || array.size() == 0 || array.size() / 3 > max_image_pixels) {
        std::string shape;
        for (py::ssize_t i = 0; i < array.ndim(); ++i) shape += fmt::format("{}{}", i > 0 ? ", " : "", array.shape(i));
        throw InputError(fmt::format("{}: expected the shape (height, width, 3), found ({})", name, shape));
    }
    Image image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
    std::copy_n(array.data(), array.size(), reinterpret_cast<float*>(image.pixels.data()));
    return image;
}

void bind_pictures(py::module_& m) {
    bind_tracing(m);
    bind_differences(m);
    m.def("render_elements", &render_elements, py::arg("solution"), py::arg("view"), py::arg("width"),
          py::arg("height"), py::arg("samples"), py::arg("is_flat"), py::arg("irradiance"), py::arg("crease_angle"),
          py::arg("seed"), py::arg("threads"), py::arg("progress"), docs::render);
    m.def("trace", &trace, py::arg("lit"), py::arg("shading"), py::arg("view"), py::arg("width"), py::arg("height"),
          py::arg("samples"), py::arg("until"), py::arg("max_samples"), py::arg("time"), py::arg("irradiance"),
          py::arg("mirrors"), py::arg("light_walks"), py::arg("seed"), py::arg("threads"), py::arg("progress"));
    m.def(
        "automatic_exposure", [](const Floats& image) { return automatic_exposure(image_of(image, "image")); },
        py::arg("image"), docs::automatic_exposure);
    m.def(
        "tonemap",
        [](const Floats& image, const std::optional<float>& exposure, const std::string& curve,
           float display_luminance) {
            const Image mapped = display_values(image, exposure, curve, display_luminance);
            return display_bytes(mapped);
        },
        py::arg("image"), py::arg("exposure"), py::arg("curve"), py::arg("display_luminance"), docs::tone_map);
    m.def(
        "png",
        [](const Floats& image, const std::optional<float>& exposure, const std::string& curve) {
            return py::bytes(
                detail::codecs::encode_png(display_values(image, exposure, curve, usual_display_luminance)));
        },
        py::arg("image"), py::arg("exposure") = py::none(), py::arg("curve") = "srgb",
        "PNG file of a picture of radiance, as for tonemap().");
    m.def(
        "read_image", [](const std::filesystem::path& path) { return array_of(read_image(path)); }, py::arg("path"),
        docs::read_image);
    m.def(
        "write_image",
        [](const std::filesystem::path& path, const Floats& image, const std::optional<float>& exposure,
           const std::string& curve, const std::string& quantity) {
            const bool is_mapped = needs_tone_mapping(require_image_format(path));
            ImageMetadata metadata;
            metadata.quantity = quantity;
            metadata.version = INTERFLECT_VERSION;
            write_image(
                path,
                is_mapped ? display_values(image, exposure, curve, usual_display_luminance) : image_of(image, "image"),
                metadata);
        },
        py::arg("path"), py::arg("image"), py::arg("exposure") = py::none(), py::arg("curve") = "srgb",
        py::arg("quantity") = "radiance [cd/m^2]",
        "Writes a picture of radiance. For .png and .jpg it is tone-mapped, see tonemap(); .exr and .hdr contain the "
        "values themselves.\n\nRaises:\n    InputError: for an unknown extension or shape.");
    m.def(
        "compare",
        [](const Floats& image, const Floats& reference, bool scale, double field_of_view, bool tone_mapped) {
            const Image a = image_of(image, "image"), b = image_of(reference, "reference");
            return long_work(py::none(), 0, [&](const Monitor&) {
                return std::make_shared<detail::ImageDifference>(
                    detail::compare(a, b, {scale, field_of_view, tone_mapped}));
            });
        },
        py::arg("image"), py::arg("reference"), py::kw_only(), py::arg("scale") = false, py::arg("field_of_view") = 45,
        py::arg("tone_mapped") = false,
        "Difference of two pictures of the same light, as interflect compare (docs/metrics.md).\n\nArgs:\n"
        "    image: (h, w, 3). Larger than the reference by a whole factor, it is averaged over blocks.\n"
        "    reference: (h, w, 3).\n    scale: Divides the image by the ratio of the means first.\n"
        "    field_of_view: Vertical [degrees], in (0, 180).\n    tone_mapped: Whether both are display values in "
        "[0, 1].\n\nRaises:\n    InputError: for other sizes or an option out of range.");
}

}  // namespace interflect::python
