#include "interflect/scene/environment_maps.h"

#include <algorithm>

namespace interflect::inline detail {

std::vector<std::shared_ptr<const Texture>> environment_maps(const Scene& scene) {
    std::vector<std::shared_ptr<const Texture>> images;
    for (const Luminaire& luminaire : scene.luminaires)
        if (const auto* map = std::get_if<EnvironmentMap>(&luminaire.kind))
            if (std::find(images.begin(), images.end(), map->image) == images.end()) images.push_back(map->image);
    return images;
}

}  // namespace interflect::inline detail
