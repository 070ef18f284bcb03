#include "bindings.h"
#include "fields.h"

namespace interflect::python {

namespace {

void bind_webs(py::module_& m) {
    py::class_<PhotometricWeb, std::shared_ptr<PhotometricWeb>> web(m, "PhotometricWeb", docs::PhotometricWeb);
    web.def_readonly("name", &PhotometricWeb::name, docs::PhotometricWeb_name);
    web.def_readonly("lamp_lumens", &PhotometricWeb::lamp_lumens, docs::PhotometricWeb_lamp_lumens);
    web.def_property_readonly(
        "pole", [](const PhotometricWeb& w) { return w.pole == PhotometricWeb::Pole::nadir ? "nadir" : "c90"; },
        "Pole of `polar`: 'nadir' (types C and A; azimuths run from x to y) or 'c90' (type B; the pole is y, azimuths "
        "run "
        "from the nadir to x).");
    web.def_property_readonly(
        "polar", [](const std::shared_ptr<PhotometricWeb>& w) { return rows<float>(w, w->polar); },
        array_text("(p,) float32", docs::PhotometricWeb_polar).c_str());
    web.def_property_readonly(
        "azimuth", [](const std::shared_ptr<PhotometricWeb>& w) { return rows<float>(w, w->azimuth); },
        array_text("(a,) float32", docs::PhotometricWeb_azimuth).c_str());
    web.def_property_readonly(
        "intensities",
        [](const std::shared_ptr<PhotometricWeb>& w) {
            const auto columns = static_cast<py::ssize_t>(w->polar.size());
            return read_only(std::shared_ptr<const void>(w), w->intensities.data(),
                             {static_cast<py::ssize_t>(w->azimuth.size()), columns},
                             {columns * static_cast<py::ssize_t>(sizeof(float)), sizeof(float)});
        },
        "(a, p) float32: intensity [cd or W/sr] by azimuth and polar angle.");
    web.def("flux", &PhotometricWeb::flux, Documented(docs::PhotometricWeb_flux));
    web.def("peak", &PhotometricWeb::peak, Documented(docs::PhotometricWeb_peak));
    web.def("__repr__", [](const PhotometricWeb& w) {
        return "<PhotometricWeb '" + w.name + "': " + std::to_string(w.azimuth.size()) + " x " +
               std::to_string(w.polar.size()) + " angles>";
    });
}

void bind_local_lights(py::module_& m) {
    Fields<PointLight>(m, "PointLight", docs::PointLight)
        .field("position", &PointLight::position, docs::PointLight_position)
        .field("intensity", &PointLight::intensity, docs::PointLight_intensity)
        .finish();
    Fields<SpotLight>(m, "SpotLight", docs::SpotLight)
        .field("position", &SpotLight::position, docs::SpotLight_position)
        .field("direction", &SpotLight::direction, docs::SpotLight_direction)
        .field("intensity", &SpotLight::intensity, docs::SpotLight_intensity)
        .field("inner_angle", &SpotLight::inner_angle, docs::SpotLight_inner_angle)
        .field("outer_angle", &SpotLight::outer_angle, docs::SpotLight_outer_angle)
        .finish();
    const auto web = [](const MeasuredLight& light) { return without_const(light.web); };
    const auto set_web = [](MeasuredLight& light, const std::shared_ptr<PhotometricWeb>& w) { light.web = w; };
    Fields<MeasuredLight>(m, "MeasuredLight", docs::MeasuredLight)
        .field("web", web, set_web, docs::MeasuredLight_web)
        .field("position", &MeasuredLight::position, docs::MeasuredLight_position)
        .field("direction", &MeasuredLight::direction, docs::MeasuredLight_direction)
        .field("c0", &MeasuredLight::c0, docs::MeasuredLight_c0)
        .field("mirrored", &MeasuredLight::mirrored, docs::MeasuredLight_mirrored)
        .field("factor", &MeasuredLight::factor, docs::MeasuredLight_factor)
        .finish();
}

void bind_distant_lights(py::module_& m) {
    Fields<DirectionalLight>(m, "DirectionalLight", docs::DirectionalLight)
        .field("direction", &DirectionalLight::direction, docs::DirectionalLight_direction)
        .field("irradiance", &DirectionalLight::irradiance, docs::DirectionalLight_irradiance)
        .field("diameter", &DirectionalLight::diameter, docs::DirectionalLight_diameter)
        .finish();
    Fields<UniformSky>(m, "UniformSky", docs::UniformSky)
        .field("radiance", &UniformSky::radiance, docs::UniformSky_radiance)
        .finish();
    Fields<SkyModel>(m, "SkyModel", docs::SkyModel)
        .field("a", &SkyModel::a, "Coefficient a.")
        .field("b", &SkyModel::b, "Coefficient b.")
        .field("c", &SkyModel::c, "Coefficient c.")
        .field("d", &SkyModel::d, "Coefficient d.")
        .field("e", &SkyModel::e, "Coefficient e.")
        .field("g", &SkyModel::g, "Coefficient g.")
        .finish();
    m.def("cie_standard_sky", &cie_standard_sky, py::arg("type"), Documented(docs::cie_standard_sky));
    Fields<SkyDome>(m, "SkyDome", docs::SkyDome)
        .field("model", &SkyDome::model, "Relative luminance: cie_standard_sky(type).")
        .field("irradiance", &SkyDome::irradiance, docs::SkyDome_irradiance)
        .field("zenith", &SkyDome::zenith, docs::SkyDome_zenith)
        .field("sun", &SkyDome::sun, docs::SkyDome_sun)
        .field("ground", &SkyDome::ground, docs::SkyDome_ground)
        .finish();
    const auto image = [](const EnvironmentMap& map) { return without_const(map.image); };
    const auto set_image = [](EnvironmentMap& map, const std::shared_ptr<Texture>& texture) { map.image = texture; };
    Fields<EnvironmentMap>(m, "EnvironmentMap", docs::EnvironmentMap)
        .field("image", image, set_image, "Texture of radiances.")
        .field("zenith", &EnvironmentMap::zenith, docs::EnvironmentMap_zenith)
        .field("north", &EnvironmentMap::north, docs::EnvironmentMap_north)
        .field("factor", &EnvironmentMap::factor, docs::EnvironmentMap_factor)
        .finish();
}

}  // namespace

void bind_light_sources(py::module_& m) {
    bind_webs(m);
    bind_local_lights(m);
    bind_distant_lights(m);
    Fields<Luminaire>(m, "Luminaire", docs::Luminaire)
        .field("name", &Luminaire::name, "Name.")
        .field("kind", &Luminaire::kind,
               "PointLight, SpotLight, MeasuredLight, DirectionalLight, UniformSky, SkyDome or EnvironmentMap.")
        .field("object", &Luminaire::object, docs::Luminaire_object)
        .finish();
}

}  // namespace interflect::python
