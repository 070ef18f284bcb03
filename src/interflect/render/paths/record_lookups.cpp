#include "interflect/render/paths/record_lookups.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

#include "interflect/render/paths/group_mean.h"
#include "interflect/render/paths/indirect_field.h"
#include "interflect/render/paths/sky_guide.h"

namespace interflect::detail {

const RecordLookups::Group& RecordLookups::group_of(const Path& path, std::uint32_t pixel) {
    constexpr float same_cosine = 0.999f;
    const std::uint32_t batch = path.half_batch / 2;
    for (std::size_t i = groups_.size(); i > 0 && groups_[i - 1].batch == batch; --i)
        if (groups_[i - 1].patch == path.patch && groups_[i - 1].normal.dot(path.normal) >= same_cosine &&
            (groups_[i - 1].position - path.lookup_position).length() <= groups_[i - 1].radius)
            return groups_[i - 1];
    Group& group = groups_.emplace_back(Group{batch, path.patch, path.normal, path.lookup_position});
    const IndirectField* const field = plan_.hybrid->field;
    if (!field) {
        group.lookup.is_found = true;
        group.radius = std::numeric_limits<float>::infinity();
        return group;
    }
    const SkyGuide* const guide = plan_.hybrid->guide;
    if (const std::uint32_t own = field->own_record(pixel); own != none) {
        const IndirectField::OwnLight light = field->own_light(own);
        group.lookup.is_found = true;
        group.irradiance = light.irradiance;
        group.radius = std::numeric_limits<float>::infinity();
        if (guide && guide->sees_sky(own)) group.lookup.guide = own;
        return group;
    }
    const auto found = field->at(path.lookup_position, path.normal, path.patch);
    if (!found) return group;
    group.lookup.is_found = true;
    group.irradiance = found->irradiance;
    group.error = found->error;
    group.radius = found->reach / 2;
    if (guide && guide->sees_sky(found->record)) group.lookup.guide = found->record;
    return group;
}

RecordLookups::Lookup RecordLookups::add_indirect(const Path& path, std::uint32_t pixel, PathLight& light) {
    const Group& group = group_of(path, pixel);
    const Rgb per_irradiance = path.throughput / std::numbers::pi_v<float>;
    light.indirect += RgbD(per_irradiance * group.irradiance);
    const double share = mean_channel(RgbD(per_irradiance));
    light.record_error += share * static_cast<double>(group.error);
    return group.lookup;
}

}  // namespace interflect::detail
