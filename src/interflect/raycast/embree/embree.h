#pragma once

// Embree 3 or 4; private to this folder.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/raycast/embree/coincident.h"
#include "interflect/raycast/embree/ray_recorder.h"

namespace interflect::detail {

inline RTCRayHit embree_query(const Ray& ray) {
    RTCRayHit query;
    query.ray = {ray.origin.x,
                 ray.origin.y,
                 ray.origin.z,
                 0.0f,
                 ray.direction.x,
                 ray.direction.y,
                 ray.direction.z,
                 0.0f,
                 std::numeric_limits<float>::infinity(),
                 ~0u,
                 0,
                 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

#if RTC_VERSION_MAJOR >= 4
/// Embree 4 needs no context and has no streams.
class EmbreeContext {
  public:
    void intersect(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &query); }
    void intersect(RTCScene scene, std::span<RTCRayHit> queries) {
        for (RTCRayHit& query : queries) rtcIntersect1(scene, &query);
    }
    void intersect(RTCScene scene, std::array<int, 8> valid, RTCRayHit8& p) { rtcIntersect8(valid.data(), scene, &p); }
    void intersect(RTCScene scene, std::array<int, 16> valid, RTCRayHit16& p) {
        rtcIntersect16(valid.data(), scene, &p);
    }
};
#else
class EmbreeContext {
  public:
    EmbreeContext() { rtcInitIntersectContext(&context_); }
    void intersect(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &context_, &query); }
    void intersect(RTCScene scene, std::span<RTCRayHit> queries) {
        rtcIntersect1M(scene, &context_, queries.data(), static_cast<unsigned>(queries.size()), sizeof(RTCRayHit));
    }
    void intersect(RTCScene scene, const std::array<int, 8>& valid, RTCRayHit8& packet) {
        alignas(32) std::array<int, 8> mask = valid;
        rtcIntersect8(mask.data(), scene, &context_, &packet);
    }
    void intersect(RTCScene scene, const std::array<int, 16>& valid, RTCRayHit16& packet) {
        alignas(64) std::array<int, 16> mask = valid;
        rtcIntersect16(mask.data(), scene, &context_, &packet);
    }

  private:
    RTCIntersectContext context_;
};
#endif

/// Faces of one Embree geometry.
struct Faces {
    std::vector<std::uint32_t> fronts;  // patches; the back of a face is the patch after its front
    bool triangles = false, two_sided = false;
};

}  // namespace interflect::detail

struct interflect::RayCaster::Embree {
    std::atomic<std::int64_t> bytes{0};
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<detail::Faces> geometries;
    detail::CoincidentFaces coincident;
    detail::RayRecorder* recorder = nullptr;  // set only during measurements

    explicit Embree(detail::CoincidentFaces coincident_faces);
    ~Embree();
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    void add_faces(const Scene& source, detail::Faces faces);
    void commit();
    Hit hit_of(const Ray& ray, const RTCRayHit& query) const;
};
