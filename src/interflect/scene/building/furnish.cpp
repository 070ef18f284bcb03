#include "interflect/scene/building/furnish.h"

#include <fmt/format.h>

namespace interflect::building {

std::uint32_t Furnisher::add_object(std::string_view name) {
    scene_.objects.push_back(fmt::format("room-{}.{}-{}", room_, name, count_++));
    return static_cast<std::uint32_t>(scene_.objects.size() - 1);
}

void Furnisher::add(const Furniture& piece, const Placement& place) {
    piece.build(Solids(scene_, place, add_object(piece.name)), palette_, random_);
}

void Furnisher::add_luminaire_at(float x, float y, float height, bool turned) {
    const Placement place = Placement::quarter_turned({x, y, height}, turned ? 1 : 0);
    add_luminaire(Solids(scene_, place, add_object("luminaire")), palette_, random_);
}

}  // namespace interflect::building
