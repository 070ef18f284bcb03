#include "interflect/scene/sky/environment_maps.h"

#include <fmt/format.h>

#include <algorithm>

namespace interflect::detail {

std::vector<std::shared_ptr<const Texture>> environment_maps(const Scene& scene) {
    std::vector<std::shared_ptr<const Texture>> images;
    for (const Luminaire& luminaire : scene.luminaires)
        if (const auto* map = std::get_if<EnvironmentMap>(&luminaire.kind))
            if (std::find(images.begin(), images.end(), map->image) == images.end()) images.push_back(map->image);
    return images;
}

std::string sky_count_fault(const Scene& scene) {
    const auto count = std::count_if(scene.luminaires.begin(), scene.luminaires.end(), [](const Luminaire& l) {
        return is_sky(l) && !std::holds_alternative<UniformSky>(l.kind);
    });
    if (count > std::ptrdiff_t{max_skies})
        return fmt::format("has {} skies that are not uniform; expected at most {}", count, max_skies);
    std::uint64_t texels = 0;
    for (const auto& image : environment_maps(scene)) texels += image ? image->texels.size() : 0;
    if (texels > max_environment_texels)
        return fmt::format("has environment maps of {} texels together; expected at most {}", texels,
                           max_environment_texels);
    return {};
}

}  // namespace interflect::detail
