#include "interflect/render/lights/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "interflect/elements/texture_means.h"
#include "interflect/scene/core/limits.h"

namespace interflect::detail {

namespace {

constexpr std::size_t bin_count = 16;  // more bins have no measurable benefit

V3f smaller(const V3f& a, const V3f& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
V3f larger(const V3f& a, const V3f& b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

}  // namespace

void LightTree::Box::extend(const Box& other) {
    low = smaller(low, other.low);
    high = larger(high, other.high);
}

LightTree::Cone LightTree::bounding_cone(const Cone& a, const Cone& b) {
    constexpr float pi = std::numbers::pi_v<float>;
    constexpr float parallel = 1e-4f;  // [rad]; rounding dominates the plane of axes that are closer
    const auto angle = [](float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)); };
    const float angle_a = angle(a.cosine), angle_b = angle(b.cosine), between = angle(a.axis.dot(b.axis));
    if (std::min(between + angle_b, pi) <= angle_a + parallel)
        return {a.axis, std::cos(std::min(pi, angle_a + parallel))};
    if (std::min(between + angle_a, pi) <= angle_b + parallel)
        return {b.axis, std::cos(std::min(pi, angle_b + parallel))};
    const float joint = 0.5f * (angle_a + between + angle_b);
    if (joint >= pi || between > pi - parallel) return {a.axis, -1};
    const float turn = joint - angle_a;
    const V3f axis = (std::sin(between - turn) * a.axis + std::sin(turn) * b.axis).normalized();
    return {axis, std::cos(joint)};
}

namespace {

/// Exitance that determines the sampling probability of a patch: sum of channels [lm/m^2 or W/m^2].
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
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
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

struct LightTree::BinaryNode {
    Box box;
    Cone cone;
    float power;          // [W or lm]
    std::uint32_t light;  // none in inner nodes
    std::uint32_t children[2];

    float radius() const { return 0.5f * (box.high - box.low).length(); }
};

LightTree::LightTree(std::vector<Light> lights, std::size_t index_count)
    : slot_(index_count, none), light_count_(lights.size()) {
    if (lights.empty()) return;
    std::vector<BinaryNode> binary;
    binary.reserve(2 * lights.size() - 1);
    add_node(binary, build(lights, binary), none);
}

struct LightTree::Split {
    int axis = 0;
    float low = 0, scale = 0;
    std::size_t first_above = 0;  // first bin above the split; 0 if all centres coincide
    float cost = std::numeric_limits<float>::infinity();

    std::size_t bin_of(const V3f& centre) const {
        return std::min(bin_count - 1, static_cast<std::size_t>((centre[axis] - low) * scale));
    }
};

struct LightTree::Bin {
    float power = 0;
    Box box;
    V3f normals{0, 0, 0};  // sum of the normals, weighted by power

    void add(const Bin& other) {
        if (other.power <= 0) return;
        if (power > 0)
            box.extend(other.box);
        else
            box = other.box;
        power += other.power;
        normals += other.normals;
    }
    /// Approximates the surface area orientation heuristic, power x area x solid angle: the squared diagonal represents
    /// the area, and normals that cancel each other represent a large solid angle.
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
        // Sum the costs of both sides for each boundary between bins
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

std::uint32_t LightTree::build(std::span<Light> lights, std::vector<BinaryNode>& nodes) {
    const Light& first = lights.front();
    if (lights.size() == 1) {
        nodes.push_back({first.box, first.cone, first.power, first.index, {none, none}});
        return static_cast<std::uint32_t>(nodes.size() - 1);
    }
    Box box = first.box, centres{first.centre(), first.centre()};
    for (const Light& l : lights) {
        box.extend(l.box);
        centres.extend({l.centre(), l.centre()});
    }
    const Split split = best_split(lights, centres);
    const auto middle = std::stable_partition(
        lights.begin(), lights.end(), [&](const Light& l) { return split.bin_of(l.centre()) < split.first_above; });
    // If all centres coincide, one part is empty.
    std::size_t first_count = static_cast<std::size_t>(middle - lights.begin());
    if (first_count == 0 || first_count == lights.size()) first_count = lights.size() / 2;
    const std::uint32_t a = build(lights.first(first_count), nodes), b = build(lights.subspan(first_count), nodes);
    nodes.push_back({box, bounding_cone(nodes[a].cone, nodes[b].cone), nodes[a].power + nodes[b].power, none, {a, b}});
    return static_cast<std::uint32_t>(nodes.size() - 1);
}

/// Adds the node of a binary subtree. Its widest child is replaced by two children until the node has eight.
void LightTree::add_node(const std::vector<BinaryNode>& binary, std::uint32_t root, std::uint32_t slot_in_parent) {
    std::vector<std::uint32_t> children{root};
    while (children.size() < width) {
        const auto widest = std::max_element(children.begin(), children.end(), [&](std::uint32_t a, std::uint32_t b) {
            const auto extent = [&](std::uint32_t i) { return binary[i].light == none ? binary[i].radius() : -1; };
            return extent(a) < extent(b);
        });
        const BinaryNode& divided = binary[*widest];
        if (divided.light != none) break;
        *widest = divided.children[0];
        children.push_back(divided.children[1]);
    }
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    nodes_[index].radius.fill(1);
    nodes_[index].slot_in_parent = slot_in_parent;
    for (std::uint32_t i = 0; i < children.size(); ++i) {
        const BinaryNode& child = binary[children[i]];
        const std::uint32_t slot = index * static_cast<std::uint32_t>(width) + i;
        Node& node = nodes_[index];
        node.centre.set(i, 0.5f * (child.box.low + child.box.high));
        node.half_size.set(i, 0.5f * (child.box.high - child.box.low));
        node.radius[i] = std::max(child.radius(), std::numeric_limits<float>::min());
        node.axis.set(i, child.cone.axis);
        node.cone_cosine[i] = child.cone.cosine;
        node.cone_sine[i] = std::sqrt(std::max(0.0f, 1 - child.cone.cosine * child.cone.cosine));
        node.power[i] = child.power;
        node.is_light[i] = child.light != none;
        node.child[i] = child.light != none ? child.light : static_cast<std::uint32_t>(nodes_.size());
        if (child.light != none)
            slot_[child.light] = slot;
        else
            add_node(binary, children[i], slot);
    }
}

/// Computes the importance of each child: power x bounds of both cosines / squared distance. The cosines use the
/// nearest point of the box, so wide nodes around x are sampled more often than their distance suggests.
LightTree::Choices LightTree::importance_of_children(const Node& node, const Floats& power, const V3f& x,
                                                     const V3f& n) {
    constexpr float least = std::numeric_limits<float>::min();
    Choices choices;
    for (std::size_t i = 0; i < width; ++i) {
        const float dx = node.centre.x[i] - x.x, dy = node.centre.y[i] - x.y, dz = node.centre.z[i] - x.z;
        const float hx = node.half_size.x[i], hy = node.half_size.y[i], hz = node.half_size.z[i];
        const float ax = node.axis.x[i], ay = node.axis.y[i], az = node.axis.z[i];
        // `height` is the greatest height of the box above the surface, and `ahead` the distance of x in front of the
        // rearmost point of the box, along its axis.
        const float height =
            n.x * dx + n.y * dy + n.z * dz + std::abs(n.x) * hx + std::abs(n.y) * hy + std::abs(n.z) * hz;
        const float ahead = std::abs(ax) * hx + std::abs(ay) * hy + std::abs(az) * hz - (ax * dx + ay * dy + az * dz);
        const float gap_x = std::max(0.0f, std::abs(dx) - hx), gap_y = std::max(0.0f, std::abs(dy) - hy),
                    gap_z = std::max(0.0f, std::abs(dz) - hz);
        const float nearest2 = gap_x * gap_x + gap_y * gap_y + gap_z * gap_z, centre2 = dx * dx + dy * dy + dz * dz;
        const float per_distance = 1 / std::sqrt(std::max(nearest2, least)), radius = node.radius[i];
        const float receiving = std::clamp(height * per_distance, 0.0f, 1.0f);
        // If x is behind the whole box, the bound is the cosine at the farthest possible distance.
        const float cosine = ahead < 0 ? ahead / (std::sqrt(centre2) + radius) : std::min(1.0f, ahead * per_distance);
        const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
        const float outside_cone = cosine * node.cone_cosine[i] + sine * node.cone_sine[i];
        const float emitting = cosine >= node.cone_cosine[i] ? 1 : std::max(0.0f, outside_cone);
        choices.importance[i] = power[i] * receiving * emitting / std::max(centre2, radius * radius);
    }
    choices.sum = 0;
    for (const float importance : choices.importance) choices.sum += importance;
    return choices;
}

void LightTree::weigh(std::span<const float> weights) {
    is_weighted_ = true;
    for (std::size_t i = nodes_.size(); i-- > 0;) {  // children come after their parents
        Node& node = nodes_[i];
        for (std::size_t k = 0; k < width; ++k) {
            if (!(node.power[k] > 0)) continue;
            const Floats& below = nodes_[node.is_light[k] ? i : node.child[k]].weighted_power;
            node.weighted_power[k] = node.is_light[k] ? node.power[k] * weights[node.child[k]]
                                                      : std::accumulate(below.begin(), below.end(), 0.0f);
        }
    }
}

LightTree::Choice LightTree::choose(const V3f& x, const V3f& n, double uniform) const {
    if (nodes_.empty()) return {};
    if (!is_weighted_) return choose_by(false, x, n, uniform);
    return uniform < 0.5 ? choose_by(false, x, n, 2 * uniform) : choose_by(true, x, n, 2 * uniform - 1);
}

LightTree::Choice LightTree::choose_by(bool is_weighted, const V3f& x, const V3f& n, double uniform) const {
    constexpr double below_one = 0x1.fffffffffffffp-1;
    float probability = 1, weighted_probability = 1;
    for (const Node* node = nodes_.data();;) {
        const Choices by_power = importance_of_children(*node, node->power, x, n);
        if (!(by_power.sum > 0)) return {};
        const Choices by_weight = is_weighted_ ? importance_of_children(*node, node->weighted_power, x, n) : by_power;
        const auto& [importance, sum] = is_weighted ? by_weight : by_power;
        // Choose a child; reuse the random number
        double rest = uniform * static_cast<double>(sum);
        std::size_t i = 0, last = 0;
        for (; i < width && rest >= static_cast<double>(importance[i]); ++i) {
            rest -= static_cast<double>(importance[i]);
            if (importance[i] > 0) last = i;
        }
        if (i == width) {  // rounding made the sum of the importances too small
            i = last;
            rest = static_cast<double>(importance[i]);
        }
        uniform = std::min(rest / static_cast<double>(importance[i]), below_one);
        probability *= by_power.importance[i] / by_power.sum;
        weighted_probability *= by_weight.importance[i] / by_weight.sum;
        if (node->is_light[i]) return {node->child[i], (probability + weighted_probability) / 2};
        node = &nodes_[node->child[i]];
    }
}

float LightTree::probability(std::uint32_t index, const V3f& x, const V3f& n) const {
    if (slot_[index] == none) return 0;
    const auto product = [&](Floats Node::*power) {
        float probability = 1;
        for (std::uint32_t slot = slot_[index]; slot != none; slot = nodes_[slot / width].slot_in_parent) {
            const Node& node = nodes_[slot / width];
            const auto [importance, sum] = importance_of_children(node, node.*power, x, n);
            if (!(sum > 0)) return 0.0f;
            probability *= importance[slot % width] / sum;
        }
        return probability;
    };
    const float by_power = product(&Node::power);
    return is_weighted_ ? (by_power + product(&Node::weighted_power)) / 2 : by_power;
}

}  // namespace interflect::detail
