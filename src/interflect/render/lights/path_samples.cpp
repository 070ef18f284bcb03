#include "interflect/render/lights/path_samples.h"

#include <cmath>
#include <numbers>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/geometry/textures/tangent_frame.h"

namespace interflect::detail {

namespace {

/// Number of path vertices that use Sobol' points. Later vertices do not benefit from them.
constexpr std::uint32_t stratified_vertices = 4;

}  // namespace

V3f cosine_direction(const V3f& n, float a, float b) {
    const TangentFrame frame(n);
    const float radius = std::sqrt(a), height = std::sqrt(1 - a), turn = 2 * std::numbers::pi_v<float> * b;
    return frame.s * (radius * std::cos(turn)) + frame.t * (radius * std::sin(turn)) + n * height;
}

VertexSample vertex_sample(std::uint64_t key, std::uint32_t vertex, std::uint32_t index) {
    const std::uint64_t of_vertex = mix(key, vertex);
    const auto words = random_words(of_vertex, index);
    if (vertex > stratified_vertices) return {unit_float(words[2]), unit_float(words[3]), unit_float(words[1])};
    const auto point = shuffled_point(mix(of_vertex, 2), index);
    return {point[0], point[1], unit_float(words[1])};
}

LightSample light_sample(std::uint64_t key, std::uint32_t vertex, LightStream stream, std::uint32_t index) {
    constexpr std::uint64_t first_stream = 16;  // vertex_sample() uses smaller numbers for its keys
    const std::uint64_t of_stream = mix(mix(key, vertex), first_stream + static_cast<std::uint64_t>(stream));
    const auto words = random_words(of_stream, index);
    if (vertex > stratified_vertices)
        return {(words[0] + 0.5) * 0x1p-32, unit_float(words[1]), unit_float(words[2]), unit_float(words[3])};
    // The first two dimensions are stratified best: they choose the point or direction.
    const auto point = shuffled_point(of_stream, index);
    // The 23 bits of a coordinate are too few to choose among millions of lamps, so random bits are appended.
    const double within_cell = (words[0] + 0.5) * 0x1p-32 - 0.5;
    return {point[2] + within_cell * 0x1p-23, point[0], point[1], point[3]};
}

}  // namespace interflect::detail
