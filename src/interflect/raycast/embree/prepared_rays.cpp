#include "interflect/raycast/embree/prepared_rays.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "interflect/raycast/embree/embree.h"

namespace interflect::detail {

namespace {

constexpr std::size_t group_rays = 1024;

void set_ray(RTCRayHit& query, std::size_t, const Ray& ray) { query = embree_query(ray); }

template <class Packet>
void set_ray(Packet& packet, std::size_t lane, const Ray& ray) {
    auto& r = packet.ray;
    r.org_x[lane] = ray.origin.x;
    r.org_y[lane] = ray.origin.y;
    r.org_z[lane] = ray.origin.z;
    r.dir_x[lane] = ray.direction.x;
    r.dir_y[lane] = ray.direction.y;
    r.dir_z[lane] = ray.direction.z;
    r.tnear[lane] = 0;
    r.tfar[lane] = std::numeric_limits<float>::infinity();
    r.time[lane] = 0;
    r.mask[lane] = ~0u;
    r.id[lane] = 0;
    r.flags[lane] = 0;
    packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
}

template <class Packet>
std::vector<Packet> packed(std::span<const Ray> rays, std::size_t lanes) {
    std::vector<Packet> packets((rays.size() + lanes - 1) / lanes);
    for (std::size_t i = 0; i < rays.size(); ++i) set_ray(packets[i / lanes], i % lanes, rays[i]);
    return packets;
}

template <class Packet>
std::size_t count_hits(const std::vector<Packet>& packets, std::size_t rays, std::size_t lanes) {
    std::size_t hits = 0;
    for (std::size_t i = 0; i < rays; ++i) {
        if constexpr (std::is_same_v<Packet, RTCRayHit>)
            hits += packets[i].hit.geomID != RTC_INVALID_GEOMETRY_ID;
        else
            hits += packets[i / lanes].hit.geomID[i % lanes] != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

template <std::size_t lanes>
std::array<int, lanes> valid_lanes(std::size_t first, std::size_t rays) {
    std::array<int, lanes> valid;
    for (std::size_t i = 0; i < lanes; ++i) valid[i] = first + i < rays ? -1 : 0;
    return valid;
}

}  // namespace

struct PreparedRays::Layout {
    RayInterface interface;
    std::size_t rays;
    std::vector<RTCRayHit> singles;
    std::vector<RTCRayHit8> packets8;
    std::vector<RTCRayHit16> packets16;
};

PreparedRays::PreparedRays(std::span<const Ray> rays, RayInterface interface)
    : layout_(std::make_unique<Layout>(Layout{interface, rays.size(), {}, {}, {}})) {
    if (interface == RayInterface::packet8)
        layout_->packets8 = packed<RTCRayHit8>(rays, 8);
    else if (interface == RayInterface::packet16)
        layout_->packets16 = packed<RTCRayHit16>(rays, 16);
    else
        layout_->singles = packed<RTCRayHit>(rays, 1);
}

PreparedRays::~PreparedRays() = default;

std::size_t PreparedRays::group_count() const { return (layout_->rays + group_rays - 1) / group_rays; }

void PreparedRays::trace_group(const RayCaster& ray_caster, std::size_t group) {
    const std::size_t begin = group * group_rays, end = std::min(layout_->rays, begin + group_rays);
    RTCScene scene = ray_caster.embree_->scene;
    EmbreeContext context;
    switch (layout_->interface) {
        case RayInterface::single:
            for (std::size_t i = begin; i < end; ++i) context.intersect(scene, layout_->singles[i]);
            break;
        case RayInterface::stream:
            context.intersect(scene, std::span(layout_->singles).subspan(begin, end - begin));
            break;
        case RayInterface::packet8:
            for (std::size_t i = begin; i < end; i += 8)
                context.intersect(scene, valid_lanes<8>(i, end), layout_->packets8[i / 8]);
            break;
        case RayInterface::packet16:
            for (std::size_t i = begin; i < end; i += 16)
                context.intersect(scene, valid_lanes<16>(i, end), layout_->packets16[i / 16]);
            break;
    }
}

std::size_t PreparedRays::hit_count() const {
    return !layout_->singles.empty()    ? count_hits(layout_->singles, layout_->rays, 1)
           : !layout_->packets8.empty() ? count_hits(layout_->packets8, layout_->rays, 8)
                                        : count_hits(layout_->packets16, layout_->rays, 16);
}

}  // namespace interflect::detail
