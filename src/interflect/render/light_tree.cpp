#include "interflect/render/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "interflect/elements/texture_means.h"
#include "interflect/scene/limits.h"

namespace interflect::detail {

namespace {

constexpr std::size_t bin_count = 16;  // more have no measurable benefit

V3f smaller(const V3f& a, const V3f& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
V3f absolute(const V3f& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }
V3f larger(const V3f& a, const V3f& b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

float support(const V3f& half, const V3f& direction) { return half.dot(absolute(direction)); }

/// Angle in [0, pi].
struct Angle {
    float cosine, sine;
    static Angle of_cosine(float c) { return {c, std::sqrt(std::max(0.0f, 1 - c * c))}; }
};

/// max(0, a - b).
Angle less(const Angle& a, const Angle& b) {
    if (a.cosine >= b.cosine) return {1, 0};
    return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
}

}  // namespace

void LightTree::Box::extend(const Box& other) {
    low = smaller(low, other.low);
    high = larger(high, other.high);
}

LightTree::Cone LightTree::bounding_cone(const Cone& a, const Cone& b) {
    constexpr float pi = std::numbers::pi_v<float>;
    constexpr float parallel = 1e-4f;  // [rad]; closer axes define no plane
    const auto angle = [](float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)); };
    const float of_a = angle(a.cosine), of_b = angle(b.cosine), between = angle(a.axis.dot(b.axis));
    if (std::min(between + of_b, pi) <= of_a + parallel) return {a.axis, std::cos(std::min(pi, of_a + parallel))};
    if (std::min(between + of_a, pi) <= of_b + parallel) return {b.axis, std::cos(std::min(pi, of_b + parallel))};
    const float joint = 0.5f * (of_a + between + of_b);
    if (joint >= pi || between > pi - parallel) return {a.axis, -1};
    const float turn = joint - of_a;
    const V3f axis = (std::sin(between - turn) * a.axis + std::sin(turn) * b.axis).normalized();
    return {axis, std::cos(joint)};
}

namespace {

/// Sum of channels [lm/m^2 or W/m^2].
class SampledExitance {
  public:
    explicit SampledExitance(const Scene& scene) : scene_(scene), largest_(largest_texels(scene)) {
        const bool any = std::any_of(scene.materials.begin(), scene.materials.end(), has_texture);
        if (any) means_.emplace(scene);
    }

    float of(const Patch& patch, const PatchGeometry& geometry) const {
        constexpr float share_of_largest = 0.01f;
        const Material& material = scene_.materials[patch.material];
        if (!has_texture(material)) return channel_sum(material.exitance);
        const Rgb mean = means_->mean(material.exitance_texture, patch, geometry, Cell());
        return channel_sum(Rgb(material.exitance * (mean + largest_[material.exitance_texture] * share_of_largest)));
    }

  private:
    static bool has_texture(const Material& m) { return m.exitance_texture != none && channel_sum(m.exitance) > 0; }

    const Scene& scene_;
    std::vector<Rgb> largest_;
    std::optional<TextureMeans> means_;
};

}  // namespace

std::vector<float> emitted_powers(const Scene& scene, std::span<const PatchGeometry> geometry) {
    const SampledExitance exitance(scene);
    std::vector<float> power(scene.patches.size());
    for (std::size_t i = 0; i < power.size(); ++i)
        power[i] = exitance.of(scene.patches[i], geometry[i]) * geometry[i].area();
    return power;
}

std::vector<LightTree::Light> patch_lights(const Scene& scene, std::span<const PatchGeometry> geometry,
                                           std::span<const float> power) {
    std::vector<LightTree::Light> lights;
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
        const Patch& patch = scene.patches[i];
        if (!(power[i] > 0)) continue;
        const V3f& corner = scene.vertices[patch.vertices[0]];
        LightTree::Light light{i, power[i], {corner, corner}, {geometry[i].normal(), 1}};
        for (std::size_t v = 1; v < static_cast<std::size_t>(patch.vertex_count()); ++v) {
            const V3f& vertex = scene.vertices[patch.vertices[v]];
            light.box.extend({vertex, vertex});
        }
        lights.push_back(light);
    }
    return lights;
}

LightTree::LightTree(std::vector<Light> lights, std::size_t index_count) : leaf_(index_count, none) {
    if (lights.empty()) return;
    nodes_.reserve(2 * lights.size() - 1);
    nodes_.emplace_back();
    build(0, lights);
}

struct LightTree::Split {
    int axis = 0;
    float low = 0, scale = 0;
    std::size_t first_above = 0;  // 0: coincident centres
    float cost = std::numeric_limits<float>::infinity();

    std::size_t bin_of(const V3f& centre) const {
        return std::min(bin_count - 1, static_cast<std::size_t>((centre[axis] - low) * scale));
    }
};

struct LightTree::Bin {
    float power = 0;
    Box box;
    V3f normals{0, 0, 0};  // weighted by power

    void add(const Bin& other) {
        if (other.power <= 0) return;
        if (power > 0)
            box.extend(other.box);
        else
            box = other.box;
        power += other.power;
        normals += other.normals;
    }
    /// Approximates the surface area orientation heuristic: power x area x solid angle.
    float cost() const {
        if (power <= 0) return 0;
        return (box.high - box.low).length2() * (4 * power - 3 * normals.length());
    }
};

LightTree::Split LightTree::best_split(std::span<const Light> lights, const Box& centres) {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
        const float extent = centres.high[axis] - centres.low[axis];
        if (!(extent > 0)) continue;
        Split split{axis, centres.low[axis], static_cast<float>(bin_count) / extent};
        std::array<Bin, bin_count> bins;
        for (const Light& l : lights) {
            const float evenness = std::max(0.0f, l.cone.cosine);
            bins[split.bin_of(l.centre())].add({l.power, l.box, l.cone.axis * (l.power * evenness)});
        }
        std::array<float, bin_count> cost{};
        Bin below, above;
        for (std::size_t b = 1; b < bin_count; ++b) {
            below.add(bins[b - 1]);
            cost[b] += below.cost();
        }
        for (std::size_t b = bin_count - 1; b > 0; --b) {
            above.add(bins[b]);
            cost[b] += above.cost();
        }
        split.first_above = static_cast<std::size_t>(std::min_element(cost.begin() + 1, cost.end()) - cost.begin());
        split.cost = cost[split.first_above];
        if (split.cost < best.cost) best = split;
    }
    return best;
}

void LightTree::build(std::uint32_t node, std::span<Light> lights) {
    Box box = lights.front().box;
    Box centres{lights.front().centre(), lights.front().centre()};
    for (const Light& l : lights) {
        box.extend(l.box);
        centres.extend({l.centre(), l.centre()});
    }
    const auto finish = [&](const Cone& cone, float power) {
        LightNode& finished = nodes_[node];
        finished.centre = 0.5f * (box.low + box.high);
        finished.half = 0.5f * (box.high - box.low);
        finished.radius2 = finished.half.length2();
        finished.cone = cone;
        finished.cone_sine = Angle::of_cosine(cone.cosine).sine;
        finished.power = power;
    };
    if (lights.size() == 1) {
        finish(lights.front().cone, lights.front().power);
        nodes_[node].light = lights.front().index;
        leaf_[lights.front().index] = node;
        return;
    }

    const Split split = best_split(lights, centres);
    const auto middle = std::stable_partition(
        lights.begin(), lights.end(), [&](const Light& l) { return split.bin_of(l.centre()) < split.first_above; });
    // If all centres coincide, one half is empty.
    std::size_t first_half = static_cast<std::size_t>(middle - lights.begin());
    if (first_half == 0 || first_half == lights.size()) first_half = lights.size() / 2;

    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node].first_child = child;
    nodes_[child].parent = nodes_[child + 1].parent = node;
    build(child, lights.first(first_half));
    build(child + 1, lights.subspan(first_half));
    finish(bounding_cone(nodes_[child].cone, nodes_[child + 1].cone), nodes_[child].power + nodes_[child + 1].power);
}

// Cosines use the box's nearest point, which favours wide nodes around x.
float LightTree::importance(const LightNode& node, const V3f& x, const V3f& n) {
    const V3f to_centre = node.centre - x;
    const V3f& axis = node.cone.axis;
    const float height = n.dot(to_centre) + support(node.half, n);       // of the highest point above the surface
    const float ahead = support(node.half, axis) - axis.dot(to_centre);  // of x before the rearmost point
    if (height <= 0) return 0;
    const V3f gap = larger(absolute(to_centre) - node.half, V3f(0, 0, 0));
    const float nearest2 = gap.length2(), centre2 = to_centre.length2();
    const float inverse = 1 / std::sqrt(std::max(nearest2, std::numeric_limits<float>::min()));
    const float receiving = std::min(1.0f, height * inverse);
    float emitting = std::min(1.0f, ahead * inverse);
    if (node.cone.cosine < 1) {
        // Behind the whole box, the farthest patch has the smallest angle.
        if (ahead < 0) emitting = ahead / (std::sqrt(centre2) + std::sqrt(node.radius2));
        emitting = less(Angle::of_cosine(emitting), {node.cone.cosine, node.cone_sine}).cosine;
    }
    return node.power * receiving * std::max(0.0f, emitting) / std::max(centre2, node.radius2);
}

LightTree::Choice LightTree::choose(const V3f& x, const V3f& n, double uniform) const {
    if (nodes_.empty()) return {};
    constexpr double below_one = 0x1.fffffffffffffp-1;
    std::uint32_t node = 0;
    float probability = 1;
    if (nodes_[0].is_leaf() && importance(nodes_[0], x, n) <= 0) return {};
    while (!nodes_[node].is_leaf()) {
        const std::uint32_t child = nodes_[node].first_child;
        const float first = importance(nodes_[child], x, n), second = importance(nodes_[child + 1], x, n);
        if (!(first + second > 0)) return {};
        const float of_first = first / (first + second);
        if (uniform < static_cast<double>(of_first)) {
            uniform = std::min(uniform / static_cast<double>(of_first), below_one);
            probability *= of_first;
            node = child;
        } else {
            uniform =
                std::min((uniform - static_cast<double>(of_first)) / (1 - static_cast<double>(of_first)), below_one);
            probability *= 1 - of_first;
            node = child + 1;
        }
    }
    return {nodes_[node].light, probability};
}

float LightTree::probability(std::uint32_t index, const V3f& x, const V3f& n) const {
    std::uint32_t node = leaf_[index];
    if (node == none) return 0;
    if (nodes_[node].parent == none) return importance(nodes_[node], x, n) > 0 ? 1.0f : 0.0f;
    float probability = 1;
    for (; nodes_[node].parent != none; node = nodes_[node].parent) {
        const std::uint32_t child = nodes_[nodes_[node].parent].first_child;
        const float first = importance(nodes_[child], x, n), second = importance(nodes_[child + 1], x, n);
        if (!(first + second > 0)) return 0;
        const float of_first = first / (first + second);
        probability *= node == child ? of_first : 1 - of_first;
    }
    return probability;
}

}  // namespace interflect::detail
