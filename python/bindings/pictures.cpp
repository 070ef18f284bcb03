#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "argument.h"
#include "bindings.h"
#include "fields.h"
#include "interflect/denoise.h"
#include "interflect/image/codecs/image_codecs.h"
#include "interflect/image/codecs/srgb.h"
#include "interflect/metrics.h"
#include "interflect/preview.h"
#include "interflect/render.h"
#include "long_work.h"

namespace interflect::python {

namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using SharedRendering = std::shared_ptr<Rendering>;

/// Scene to draw, with its ray caster, and its solution if it is solved.
struct LitScene {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const RayCaster> ray_caster;
    std::shared_ptr<const Solution> solution;
};

LitScene lit_scene_of(const py::object& lit, int threads) {
    if (py::isinstance<Light>(lit)) {
        const auto light = py::cast<SharedLight>(lit);
        return {light->scene, light->ray_caster, light->solution};
    }
    const auto scene = py::cast<std::shared_ptr<Scene>>(lit);
    return {scene, pure_work(threads, [&] { return std::make_shared<const RayCaster>(*scene); }), nullptr};
}

SharedRendering draw(const py::object& lit, const py::object& view, const PictureOptions& options, int threads,
                     const py::object& progress) {
    const LitScene drawn = lit_scene_of(lit, threads);
    const View camera = view_or_overview(*drawn.scene, *drawn.ray_caster, view, threads);
    return long_work(progress, threads, [&](const Monitor& monitor) {
        return std::make_shared<Rendering>(
            drawn.solution ? render(*drawn.scene, *drawn.solution, *drawn.ray_caster, camera, options, monitor)
                           : render(*drawn.scene, *drawn.ray_caster, camera, options, monitor));
    });
}

SharedRendering draw_preview(const SharedLight& light, const py::object& view, const PictureOptions& options,
                             double reduction, const std::string& denoiser, int threads, const py::object& progress) {
    const View camera = view_or_overview(*light->scene, *light->ray_caster, view, threads);
    const PreviewOptions preview_options{reduction, find_denoiser(denoiser)};
    name_library_of_pyoidn();
    return long_work(progress, threads, [&](const Monitor& monitor) {
        return std::make_shared<Rendering>(
            preview(*light->scene, *light->solution, *light->ray_caster, camera, options, preview_options, monitor));
    });
}

/// Returns an array that shares the pixels of an image, which the rendering keeps alive.
py::array image_of_rendering(const SharedRendering& owner, const Image& image) {
    constexpr py::ssize_t number = sizeof(float);
    const auto width = static_cast<py::ssize_t>(image.width);
    return read_only(owner, reinterpret_cast<const float*>(image.pixels.data()), {image.height, width, 3},
                     {width * 3 * number, 3 * number, number});
}

py::dict layers_of(const SharedRendering& rendering) {
    const PictureLayers& l = rendering->layers;
    py::dict layers;
    for (const auto& [name, image] : {std::pair{"emitted", &l.emitted},
                                      {"direct", &l.reflected.direct},
                                      {"indirect", &l.reflected.indirect},
                                      {"albedo", &l.albedo},
                                      {"normal", &l.normal},
                                      {"position", &l.position}})
        layers[name] = image_of_rendering(rendering, *image);
    const auto width = static_cast<py::ssize_t>(rendering->image.width);
    for (const auto& [name, values] : {std::pair{"depth", &l.depth},
                                       {"level", &l.level},
                                       {"direct_variance", &l.reflected.direct_variance},
                                       {"indirect_variance", &l.reflected.indirect_variance}})
        if (!values->empty())
            layers[name] = read_only(rendering, values->data(), {rendering->image.height, width},
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
    throw InputError(fmt::format("curve: expected {}, found '{}'", known, name));
}

/// @param exposure  Exposure [stops]. None means an automatic one, which is 0 for operators of absolute luminance.
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

PictureQuantity quantity_of(const std::string& name) {
    if (name == "radiance") return PictureQuantity::radiance;
    if (name == "irradiance") return PictureQuantity::irradiance;
    throw InputError(fmt::format("quantity: expected radiance or irradiance, found '{}'", name));
}

void bind_picture_options(py::module_& m) {
    using Options = PictureOptions;
    const auto set_crease_angle = [](Options& o, float angle) {
        if (!(angle >= 0 && angle <= 180))
            throw InputError(fmt::format("crease_angle: expected 0 to 180 degrees, found {}", angle));
        o.smoothing.crease_angle = angle;
    };
    Fields<Options>(m, "PictureOptions", docs::PictureOptions)
        .field("width", &Options::width, docs::PictureOptions_width)
        .field("height", &Options::height, docs::PictureOptions_height)
        .field(
            "shading", [](const Options& o) { return label(o.shading); },
            [](Options& o, const std::string& name) { o.shading = find_shading(name, &DefaultSamples::pixel); },
            docs::Shading)
        .field(
            "samples", [](const Options& o) { return optional_samples(o.samples); },
            [](Options& o, const std::optional<int>& samples) { o.samples = samples_of(samples); },
            docs::PictureOptions_samples)
        .field("max_samples", &Options::max_samples, docs::PictureOptions_max_samples)
        .field("until", &Options::until, docs::PictureOptions_until)
        .field("time", &Options::time, docs::PictureOptions_time)
        .field(
            "quantity",
            [](const Options& o) { return o.quantity == PictureQuantity::radiance ? "radiance" : "irradiance"; },
            [](Options& o, const std::string& name) { o.quantity = quantity_of(name); }, docs::PictureQuantity)
        .field("mirrors", &Options::mirrors, docs::PictureOptions_mirrors)
        .field(
            "crease_angle", [](const Options& o) { return o.smoothing.crease_angle; }, set_crease_angle,
            docs::SmoothingOptions_crease_angle)
        .field("light_walks", &Options::light_walks, docs::PictureOptions_light_walks)
        .field("seed", &Options::seed, "The same seed gives the same bits for any number of threads.")
        .finish();
    m.def(
        "needs_solution",
        [](const std::string& shading) { return needs_solution(find_shading(shading, &DefaultSamples::pixel)); },
        py::arg("shading"), Documented(docs::needs_solution));
    m.def(
        "traces_paths",
        [](const std::string& shading) { return traces_paths(find_shading(shading, &DefaultSamples::pixel)); },
        py::arg("shading"), Documented(docs::traces_paths));
}

void bind_rendering(py::module_& m) {
    py::class_<Rendering, SharedRendering>(m, "Rendering", docs::Rendering)
        .def_property_readonly(
            "image", [](const SharedRendering& t) { return image_of_rendering(t, t->image); },
            array_text("(height, width, 3) float32", docs::Rendering_image).c_str())
        .def_property_readonly(
            "standard_error", [](const SharedRendering& t) { return image_of_rendering(t, t->standard_error); },
            array_text("(height, width, 3) float32", docs::Rendering_standard_error).c_str())
        .def_property_readonly(
            "layers", &layers_of,
            "Dict of read-only float32 arrays, the means over the samples of each pixel. (height, width, 3): "
            "'emitted', "
            "'direct' and 'indirect', whose sum is `image`; 'albedo', 'normal', 'position' of the visible surface, "
            "relative "
            "to Scene.origin [m]. (height, width): 'depth' [m]; 'level' of the visible element; 'direct_variance' and "
            "'indirect_variance' of the channel means.")
        .def_readonly("relative_error", &Rendering::relative_error, docs::Rendering_relative_error)
        .def_readonly("rays", &Rendering::rays, docs::Rendering_rays)
        .def_readonly("paths", &Rendering::paths, "Number of paths.")
        .def_readonly("non_finite_pixels", &Rendering::non_finite_pixels, docs::Rendering_non_finite_pixels)
        .def(
            "denoise",
            [](const SharedRendering& t, const std::string& denoiser) {
                const Denoiser chosen = find_denoiser(denoiser);
                name_library_of_pyoidn();
                return array_of(
                    long_work(py::none(), 0, [&](const Monitor&) { return denoise(t->layers, chosen).image; }));
            },
            py::arg("denoiser") = label(Denoiser::automatic),
            Documented(docs::denoise, {{"denoiser",
                                        "'oidn', Intel Open Image Denoise, whose library is that of the "
                                        "package pyoidn, of the system, or the file INTERFLECT_OIDN of the "
                                        "environment; 'own'; or 'auto', the first that is found."}})
                .returns("The picture, float32 (height, width, 3), in the same unit."))
        .def("__repr__", [](const Rendering& t) {
            return fmt::format("<Rendering: {} x {}, {} paths, relative error {:.3g}>", t.image.width, t.image.height,
                               t.paths, t.relative_error);
        });
}

void bind_differences(py::module_& m) {
    py::class_<BlockDifference>(m, "BlockDifference", docs::BlockDifference)
        .def_readonly("block", &BlockDifference::block, docs::BlockDifference_block)
        .def_readonly("relative_rmse", &BlockDifference::relative_rmse, docs::BlockDifference_relative_rmse)
        .def_readonly("trimmed_relative_rmse", &BlockDifference::trimmed_relative_rmse,
                      docs::BlockDifference_trimmed_relative_rmse)
        .def("__repr__", [](const BlockDifference& d) {
            return fmt::format("<BlockDifference: {} x {} pixels, relative_rmse {:.4g}>", d.block, d.block,
                               d.relative_rmse);
        });
    py::class_<ImageDifference, std::shared_ptr<ImageDifference>>(m, "ImageDifference", docs::ImageDifference)
        .def_readonly("ratio_of_means", &ImageDifference::ratio_of_means, docs::ImageDifference_ratio_of_means)
        .def_readonly("rmse", &ImageDifference::rmse, docs::ImageDifference_rmse)
        .def_readonly("relative_mse", &ImageDifference::relative_mse, docs::ImageDifference_relative_mse)
        .def_readonly("maximum", &ImageDifference::maximum, docs::ImageDifference_maximum)
        .def_readonly("perceptual_distance", &ImageDifference::perceptual_distance,
                      docs::ImageDifference_perceptual_distance)
        .def_readonly("flip", &ImageDifference::flip, docs::ImageDifference_flip)
        .def_readonly("blocks", &ImageDifference::blocks, docs::ImageDifference_blocks)
        .def_readonly("non_finite_pixels", &ImageDifference::non_finite_pixels, docs::ImageDifference_non_finite_pixels)
        .def_property_readonly(
            "flip_map", [](const ImageDifference& d) { return array_of(d.flip_map); },
            array_text("(height, width, 3) float32", docs::ImageDifference_flip_map).c_str())
        .def("__repr__", [](const ImageDifference& d) {
            return fmt::format("<ImageDifference: relative_mse {:.4g}, ratio_of_means {:.4g}, flip {:.4g}>",
                               d.relative_mse, d.ratio_of_means, d.flip);
        });
}

}  // namespace

std::optional<Denoiser> denoiser_of(const py::object& denoise) {
    if (denoise.is_none() || denoise.is(py::bool_(false))) return {};
    if (denoise.is(py::bool_(true))) return Denoiser::automatic;
    return find_denoiser(argument<std::string>(denoise, "denoise"));
}

void name_library_of_pyoidn() {
    constexpr const char* variable = "INTERFLECT_OIDN";
    if (std::getenv(variable)) return;
    const py::object package = py::module_::import("importlib.util").attr("find_spec")("pyoidn");
    if (package.is_none()) return;
    const std::filesystem::path init = py::cast<std::string>(package.attr("origin"));
    const std::filesystem::path library = init.parent_path() / "oidn" / "lib" / "libOpenImageDenoise.so.2";
    if (std::filesystem::exists(library)) setenv(variable, library.c_str(), 0);
}

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

int samples_of(const std::optional<int>& samples) {
    if (samples && *samples < 1) throw InputError(fmt::format("samples: expected 1 or more, found {}", *samples));
    return samples.value_or(0);
}

void bind_pictures(py::module_& m) {
    bind_picture_options(m);
    bind_rendering(m);
    bind_differences(m);
    m.def("render", &draw, py::arg("lit"), py::arg("view"), py::arg("options"), py::arg("threads"), py::arg("progress"),
          Documented("For interflect.render() and trace()."));
    m.def("preview", &draw_preview, py::arg("lit"), py::arg("view"), py::arg("options"), py::arg("reduction"),
          py::arg("denoiser"), py::arg("threads"), py::arg("progress"), Documented("For interflect.preview()."));
    m.def(
        "automatic_exposure", [](const Floats& image) { return automatic_exposure(image_of(image, "image")); },
        py::arg("image"),
        Documented(docs::automatic_exposure, {{"image", "Radiance, (height, width, 3)."}})
            .raises("InputError: for another shape."));
    m.def(
        "tonemap",
        [](const Floats& image, const std::optional<float>& exposure, const std::string& curve,
           float display_luminance) {
            const Image mapped = display_values(image, exposure, curve, display_luminance);
            return display_bytes(mapped);
        },
        py::arg("image"), py::arg("exposure"), py::arg("curve"), py::arg("display_luminance"),
        Documented("For interflect.tonemap()."));
    m.def(
        "png",
        [](const Floats& image, const std::optional<float>& exposure, const std::string& curve) {
            return py::bytes(
                detail::codecs::encode_png(display_values(image, exposure, curve, usual_display_luminance)));
        },
        py::arg("image"), py::arg("exposure") = py::none(), py::arg("curve") = "srgb",
        Documented("PNG file of a picture of radiance, for notebooks."));
    m.def(
        "read_image", [](const std::filesystem::path& path) { return array_of(read_image(path)); }, py::arg("path"),
        Documented(docs::read_image).returns("float32 (height, width, 3), row 0 at the top."));
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
        Documented(
            "Writes a picture of radiance. For .png and .jpg it is tone-mapped, see tonemap(); .exr and .hdr contain "
            "the values themselves.",
            {{"path", "File to write: .png, .jpg, .exr or .hdr."},
             {"image", "Radiance or another quantity, (height, width, 3); [cd/m^2] for ward, tumblin and ferwerda."},
             {"exposure", "As of tonemap(), for .png and .jpg."},
             {"curve", "As of tonemap(), for .png and .jpg."},
             {"quantity", "Name and unit of the values, which .exr files contain."}})
            .raises("InputError: for an unknown extension or another shape.\nError: if the file cannot be written."));
    m.def(
        "compare",
        [](const Floats& image, const Floats& reference, bool scale, double field_of_view, bool tone_mapped) {
            const Image a = image_of(image, "image"), b = image_of(reference, "reference");
            return pure_work(0, [&] {
                return std::make_shared<ImageDifference>(compare(a, b, {scale, field_of_view, tone_mapped}));
            });
        },
        py::arg("image"), py::arg("reference"), py::kw_only(), py::arg("scale") = false, py::arg("field_of_view") = 45,
        py::arg("tone_mapped") = false,
        Documented(docs::compare, {{"image",
                                    "(height, width, 3). Larger than the reference by a whole factor, it is "
                                    "averaged over blocks."},
                                   {"reference", "(height, width, 3)."},
                                   {"scale", docs::CompareOptions_scale},
                                   {"field_of_view", docs::CompareOptions_field_of_view},
                                   {"tone_mapped", docs::CompareOptions_tone_mapped}}));
}

}  // namespace interflect::python
