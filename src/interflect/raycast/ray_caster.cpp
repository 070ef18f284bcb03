#include "interflect/ray_caster.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/raycast/embree/embree.h"
#include "interflect/scene/core/geometry_fingerprint.h"
#include "interflect/scene/faces/planarity.h"

namespace interflect {

using namespace detail;

namespace {

/// Distance within which faces coincide, relative to the largest coordinate. Embree resolves larger distances.
constexpr auto relative_tolerance = static_cast<float>(relative_planarity);

/// Ratio of the ray offset to the distance within which faces coincide (RayCaster::ray_offset).
constexpr float offset_over_tolerance = 4;

/// Error of a hit point, relative to its largest coordinate plus the ray's length: 16 roundings of 2^-24.
constexpr float relative_hit_error = 0x1p-20f;

float largest_coordinate(const V3f& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Returns for each patch the distance within which faces coincide [m]: positive, and at least the warp of a
/// quadrilateral.
std::vector<float> tolerances(const Scene& scene) {
    constexpr std::size_t at_once = 4096;
    std::vector<float> tolerance(scene.patches.size());
    parallel_for_ranges(tolerance.size(), at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            float largest = std::numeric_limits<float>::min();
            for (int k = 0; k < scene.patches[i].vertex_count(); ++k)
                largest = std::max(
                    largest,
                    largest_coordinate(scene.vertices[scene.patches[i].vertices[static_cast<std::size_t>(k)]]));
            tolerance[i] = relative_tolerance * largest;
            if (!scene.patches[i].is_triangle())
                tolerance[i] = std::max(tolerance[i], static_cast<float>(warp(scene, scene.patches[i].vertices)));
        }
    });
    return tolerance;
}

const Scene& valid(const Scene& scene) {
    require_no_faults(scene_faults(scene), "cannot trace rays in", scene);
    return scene;
}

void throw_embree_error(void*, RTCError error, const char* message) {
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error(std::string("Embree: ") + message);
}

bool count_memory(void* counter, ssize_t bytes, bool) {
    static_cast<std::atomic<std::int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

/// Embree filter that rejects hits on backs. The normal Ng follows the vertex order.
void reject_backs(const RTCFilterFunctionNArguments* a) {
    for (unsigned i = 0; i < a->N; ++i) {
        if (a->valid[i] == 0) continue;
        const float facing = RTCRayN_dir_x(a->ray, a->N, i) * RTCHitN_Ng_x(a->hit, a->N, i) +
                             RTCRayN_dir_y(a->ray, a->N, i) * RTCHitN_Ng_y(a->hit, a->N, i) +
                             RTCRayN_dir_z(a->ray, a->N, i) * RTCHitN_Ng_z(a->hit, a->N, i);
        if (facing > 0) a->valid[i] = 0;
    }
}

}  // namespace

RayCaster::Embree::Embree(CoincidentFaces coincident_faces)
    : device(rtcNewDevice(nullptr)), coincident(std::move(coincident_faces)) {
    if (!device && rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (!device) throw std::runtime_error("Embree cannot start a device");
    rtcSetDeviceErrorFunction(device, throw_embree_error, nullptr);
    rtcSetDeviceMemoryMonitorFunction(device, count_memory, &bytes);
    scene = rtcNewScene(device);
}

RayCaster::Embree::~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
}

void RayCaster::Embree::add_faces(const Scene& source, Faces faces) {
    if (faces.fronts.empty()) return;
    const std::size_t corners = faces.triangles ? 3 : 4;
    RTCGeometry geometry =
        rtcNewGeometry(device, faces.triangles ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_QUAD);
    auto* vertices = static_cast<V3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               sizeof(V3f), source.vertices.size()));
    std::copy(source.vertices.begin(), source.vertices.end(), vertices);
    const RTCFormat format = faces.triangles ? RTC_FORMAT_UINT3 : RTC_FORMAT_UINT4;
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, format, corners * sizeof(std::uint32_t), faces.fronts.size()));
    for (std::size_t i = 0; i < faces.fronts.size(); ++i)
        std::copy_n(source.patches[faces.fronts[i]].vertices.begin(), corners, indices + i * corners);
    if (!faces.two_sided) rtcSetGeometryIntersectFilterFunction(geometry, reject_backs);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(geometries.size()));
    rtcReleaseGeometry(geometry);
    geometries.push_back(std::move(faces));
}

void RayCaster::Embree::commit() {
    // Robust mode closes gaps at shared edges. High quality builds depend on threads, which could reorder hits at equal
    // distance.
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitScene(scene);
}

Hit RayCaster::Embree::hit_of(const Ray& ray, const RTCRayHit& query) const {
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const Faces& faces = geometries[query.hit.geomID];
    const std::uint32_t front = faces.fronts[query.hit.primID];
    const float distance = query.ray.tfar;
    if (coincident.is_overlapped(front)) {
        const V3f x = ray.origin + distance * ray.direction;
        const float x_error = relative_hit_error * (largest_coordinate(x) + distance);
        const PatchIndex patch = coincident.intercepting_patch(front, x, ray.direction, x_error);
        if (patch != none) return {patch, distance};
    }
    const float facing =
        query.hit.Ng_x * ray.direction.x + query.hit.Ng_y * ray.direction.y + query.hit.Ng_z * ray.direction.z;
    return {PatchIndex(faces.two_sided && facing > 0 ? front + 1 : front), distance};
}

RayCaster::RayCaster(const Scene& scene)
    : scene_fingerprint_(geometry_fingerprint(valid(scene))), origin_(scene.origin), ray_offsets_(tolerances(scene)) {
    // Until they are scaled, ray_offsets_ contains the tolerances
    embree_ = std::make_unique<Embree>(CoincidentFaces(scene, ray_offsets_));
    for (const auto& [face, tolerance] : embree_->coincident.tolerances()) {
        ray_offsets_[face] = std::max(ray_offsets_[face], tolerance);
        if (const std::uint32_t back = scene.patches[face].other_side; back != none)
            ray_offsets_[back] = ray_offsets_[face];
    }
    for (float& offset : ray_offsets_) offset *= offset_over_tolerance;
    Faces faces[2][2];  // [triangle][two-sided]
    for (const bool triangles : {false, true})
        for (const bool two_sided : {false, true}) faces[triangles][two_sided] = {{}, triangles, two_sided};
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const Patch& patch = scene.patches[i];
        if (patch.other_side >= i && !embree_->coincident.is_hidden(i))
            faces[patch.is_triangle()][patch.other_side != none].fronts.push_back(i);
    }
    for (const bool triangles : {false, true})
        for (const bool two_sided : {false, true}) embree_->add_faces(scene, std::move(faces[triangles][two_sided]));
    embree_->commit();
}

RayCaster::~RayCaster() = default;

void RayCaster::trace(std::span<const Ray> rays, std::span<Hit> hits) const {
    if (hits.size() != rays.size())
        throw InputError(
            fmt::format("{} rays, and room for {} hits: expected the same number", rays.size(), hits.size()));
    if (embree_->recorder) embree_->recorder->record(rays);
    constexpr std::size_t at_once = 32;
    EmbreeContext context;
    std::array<RTCRayHit, at_once> queries;
    for (std::size_t begin = 0; begin < rays.size(); begin += at_once) {
        const std::size_t count = std::min(at_once, rays.size() - begin);
        for (std::size_t i = 0; i < count; ++i) queries[i] = embree_query(rays[begin + i]);
        for (std::size_t i = 0; i < count; ++i) context.intersect(embree_->scene, queries[i]);
        for (std::size_t i = 0; i < count; ++i) hits[begin + i] = embree_->hit_of(rays[begin + i], queries[i]);
    }
}

float RayCaster::uncovered_share(PatchIndex patch) const { return embree_->coincident.uncovered_share(patch); }

void RayCaster::require_made_for(const Scene& scene) const {
    interflect::require_made_for(scene, scene_fingerprint_, "the ray caster");
}

bool RayCaster::has_covered_patches() const { return embree_->coincident.has_covered_patches(); }

std::size_t RayCaster::memory() const {
    return static_cast<std::size_t>(embree_->bytes.load()) + embree_->coincident.memory() +
           ray_offsets_.capacity() * sizeof(float);
}

}  // namespace interflect
