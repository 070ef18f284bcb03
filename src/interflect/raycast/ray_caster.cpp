#include "interflect/raycast/ray_caster.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "interflect/raycast/embree.h"

namespace interflect {

namespace {

constexpr float relative_lift = 0x1p-17f;

/// Faces closer than this part of the lift coincide: 16 roundings of the largest coordinate. What transforms have moved
/// off its plane is well below it, and from there on Embree tells the distances apart.
constexpr float relative_tolerance = 0.25f;

float largest_coordinate(const Scene& scene) {
    float largest = 0;
    for (const V3f& v : scene.vertices) largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest;
}

void throw_embree_error(void*, RTCError, const char* message) {
    throw std::runtime_error(std::string("Embree: ") + message);
}

bool count_memory(void* counter, ssize_t bytes, bool) {
    static_cast<std::atomic<std::int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

/// Embree's filter for one-sided faces: a hit from behind does not count. Embree's Ng follows the vertex order.
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
    // Robust: no ray slips through a shared edge. Not high quality: Embree builds that in an order that depends on the
    // threads, and of two hits at equal distance another could win.
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitScene(scene);
}

Hit RayCaster::Embree::hit_of(const Ray& ray, const RTCRayHit& query) const {
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const Faces& faces = geometries[query.hit.geomID];
    const std::uint32_t front = faces.fronts[query.hit.primID];
    const float distance = query.ray.tfar;
    if (coincident.is_contested(front)) {
        const V3f x = ray.origin + distance * ray.direction;
        const std::uint32_t patch = coincident.answering_patch(front, x, ray.direction);
        if (patch != none) return {patch, distance};
    }
    const float facing =
        query.hit.Ng_x * ray.direction.x + query.hit.Ng_y * ray.direction.y + query.hit.Ng_z * ray.direction.z;
    return {faces.two_sided && facing > 0 ? front + 1 : front, distance};
}

RayCaster::RayCaster(const Scene& scene) : lift_(relative_lift * largest_coordinate(scene)) {
    embree_ = std::make_unique<Embree>(CoincidentFaces(scene, relative_tolerance * lift_));
    Faces faces[2][2];  // [triangle][two-sided]
    for (const bool triangles : {false, true})
        for (const bool two_sided : {false, true}) faces[triangles][two_sided] = {{}, triangles, two_sided};
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
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

std::size_t RayCaster::memory() const {
    return static_cast<std::size_t>(embree_->bytes.load()) + embree_->coincident.memory();
}

}  // namespace interflect
