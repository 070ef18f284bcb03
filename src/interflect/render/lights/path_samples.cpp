#include "interflect/render/lights/path_samples.h"

#include <cmath>
#include <numbers>

#include "interflect/base/points.h"
#include "interflect/base/random.h"
#include "interflect/geometry/tangent_frame.h"

namespace interflect::detail {

namespace {

/// Later vertices do not benefit from Sobol' points.
constexpr std::uint32_t stratified_vertices = 4;

}  // namespace

V3f cosine_direction(const V3f& n, float a, float b) {
    const TangentFrame frame(n);
    const float radius = std::sqrt(a), height = std::sqrt(1 - a), turn = 2 * std::numbers::pi_v<float> * b;
    return frame.s * (radius * std::cos(turn)) + frame.t * (radius * std::sin(turn)) + n * height;
}

VertexSample vertex_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index) {
    const std::uint64_t key = mix(batch_key, vertex);
    const auto words = random_words(key, index);
    if (vertex > stratified_vertices) return {unit_float(words[2]), unit_float(words[3]), unit_float(words[1])};
    const auto point = shuffled_point(mix(key, 2), index);
    return {point[0], point[1], unit_float(words[1])};
}

LightSample light_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index) {
    const std::uint64_t key = mix(mix(batch_key, vertex), 1);
    const auto words = random_words(key, index);
    if (vertex > stratified_vertices)
        return {(words[0] + 0.5) * 0x1p-32, unit_float(words[1]), unit_float(words[2]), unit_float(words[3])};
    const auto point = shuffled_point(key, index);
    // Points have 23 bits, too few for millions of lamps: jitter.
    const double within_cell = (words[0] + 0.5) * 0x1p-32 - 0.5;
    return {point[0] + within_cell * 0x1p-23, point[1], point[2], point[3]};
}

PlaceSample place_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index) {
    const std::uint64_t key = mix(mix(batch_key, vertex), 3);
    const auto words = random_words(key, index);
    if (vertex > stratified_vertices) return {(words[0] + 0.5) * 0x1p-32, unit_float(words[1]), unit_float(words[2])};
    const auto point = shuffled_point(key, index);
    return {point[0] + ((words[0] + 0.5) * 0x1p-32 - 0.5) * 0x1p-23, point[1], point[2]};
}

SkySample sky_sample(std::uint64_t batch_key, std::uint32_t vertex, std::uint32_t index) {
    const std::uint64_t key = mix(mix(batch_key, vertex), 4);
    const auto words = random_words(key, index);
    if (vertex > stratified_vertices) return {(words[0] + 0.5) * 0x1p-32, unit_float(words[1]), unit_float(words[2])};
    const auto point = shuffled_point(key, index);
    return {double{point[2]}, point[0], point[1]};
}

float density_per_solid_angle(const PatchGeometry& patch, float probability, const V3f& direction, float distance2) {
    const float cosine = -patch.normal().dot(direction);
    return cosine > 0 ? probability * distance2 / (patch.area() * cosine) : 0;
}

}  // namespace interflect::detail
