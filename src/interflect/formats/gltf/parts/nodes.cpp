#include "interflect/formats/gltf/parts/nodes.h"

#include <ImathQuat.h>
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "interflect/formats/reading/file_to_world.h"

namespace interflect::detail {

namespace {

using Imath::M44d;
using Imath::V3d;

V3d vector_of(const std::array<double, 3>& values) { return {values[0], values[1], values[2]}; }

/// Returns the node's matrix for row vectors, whose rows are glTF's columns.
M44d local_transform(const GltfValue& node) {
    if (node.has("matrix")) {
        const auto m = node.numbers<16>("matrix", {});
        M44d result;
        for (std::size_t i = 0; i < 16; ++i) result[static_cast<int>(i / 4)][i % 4] = m[i];
        if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) node.fail("its matrix is not affine");
        return result;
    }
    return gltf_transform(vector_of(node.numbers<3>("scale", {1, 1, 1})), node.numbers<4>("rotation", {0, 0, 0, 1}),
                          vector_of(node.numbers<3>("translation", {0, 0, 0})), node);
}

}  // namespace

M44d gltf_transform(const V3d& scale, const std::array<double, 4>& rotation, const V3d& translation,
                    const GltfValue& owner) {
    const Imath::Quatd quaternion(rotation[3], rotation[0], rotation[1], rotation[2]);
    if (!(quaternion.length() > 0)) owner.fail("its rotation is a quaternion of length 0");
    return M44d().setScale(scale) * quaternion.normalized().toMatrix44() * M44d().setTranslation(translation);
}

GltfNodes::GltfNodes(GltfAsset& asset)
    : asset_(asset), values_(asset.root().objects("nodes")), parents_(values_.size(), none), to_world_(values_.size()) {
    for (std::uint32_t i = 0; i < values_.size(); ++i) {
        children_.push_back(values_[i].indices("children", values_.size()));
        for (const std::uint32_t child : children_[i])
            if (std::exchange(parents_[child], i) != none) values_[child].fail("it is the child of two nodes");
    }
    std::vector<std::uint32_t> roots;
    for (std::uint32_t i = 0; i < values_.size(); ++i)
        if (parents_[i] == none) roots.push_back(i);
    std::size_t reached = 0;
    const M44d model_to_world = file_to_world(asset.options());
    traverse(roots, [&](std::uint32_t i) {
        ++reached;
        const M44d local = local_transform(values_[i]);
        to_world_[i] = local * (parents_[i] == none ? model_to_world : to_world_[parents_[i]]);
    });
    if (reached < values_.size()) throw GltfFault("nodes: some are their own ancestors");
}

/// Visits nodes depth first, without recursion, since nesting is unlimited.
template <class Visit>
void GltfNodes::traverse(const std::vector<std::uint32_t>& roots, const Visit& visit) const {
    std::vector<std::uint32_t> waiting(roots.rbegin(), roots.rend());
    while (!waiting.empty()) {
        const std::uint32_t node = waiting.back();
        waiting.pop_back();
        visit(node);
        waiting.insert(waiting.end(), children_[node].rbegin(), children_[node].rend());
    }
}

std::vector<std::uint32_t> GltfNodes::roots_of_scene() const {
    const std::vector<GltfValue> scenes = asset_.root().objects("scenes");
    const std::uint32_t chosen = asset_.root().index("scene", scenes.size());
    std::vector<std::uint32_t> roots;
    if (scenes.empty()) {
        for (std::uint32_t i = 0; i < values_.size(); ++i)
            if (parents_[i] == none) roots.push_back(i);
        return roots;
    }
    if (chosen == none && scenes.size() > 1)
        asset_.warn("scenes", "of several scenes, the first one is read", scenes[0].place());
    const GltfValue& scene = scenes[chosen == none ? 0 : chosen];
    std::vector<bool> is_taken(values_.size());
    for (const std::uint32_t root : scene.indices("nodes", values_.size())) {
        if (parents_[root] != none) scene.fail(fmt::format("{} is the child of another node", values_[root].place()));
        if (is_taken[root]) scene.fail(fmt::format("{} is in it twice", values_[root].place()));
        is_taken[root] = true;
        roots.push_back(root);
    }
    return roots;
}

std::vector<GltfNode> GltfNodes::in_scene() const {
    const std::size_t longest = 4 * asset_.options().max_name_length;
    std::vector<GltfNode> result;
    std::vector<std::uint32_t> index_in_result(values_.size(), none);
    traverse(roots_of_scene(), [&](std::uint32_t i) {
        index_in_result[i] = static_cast<std::uint32_t>(result.size());
        const std::string outer = parents_[i] == none ? "" : result[index_in_result[parents_[i]]].dotted;
        GltfNode node{i, &values_[i], to_world_[i], values_[i].text("name").substr(0, asset_.options().max_name_length),
                      outer};
        if (!node.name.empty()) node.dotted += (outer.empty() ? "" : ".") + node.name;
        if (node.dotted.size() > longest) {
            asset_.warn("object-name", "a name that would be too long lacks the names of its ancestors",
                        values_[i].place());
            node.dotted = node.name;
        }
        result.push_back(std::move(node));
    });
    return result;
}

}  // namespace interflect::detail
