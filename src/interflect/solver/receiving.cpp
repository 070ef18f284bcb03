#include "interflect/solver/receiving.h"

#include <algorithm>
#include <utility>

namespace interflect {

Visit Descent::root(std::uint32_t patch) const {
    Visit v;
    v.geometry = &forest_.geometry(patch);
    v.party.normal = v.geometry->normal();
    enter(v, patch, Cell());
    return v;
}

bool Descent::go_down(Visit& v, Parameters p) const { return go_to(v, forest_.first_child(v.element), p); }

bool Descent::subdivide(Visit& v, Parameters p) const {
    const std::uint32_t child = forest_.first_child(v.element);
    if (child != none) return go_to(v, child, p);
    const bool may_grow = old_size_ + std::size_t{4} <= step_.oracle.most_elements;
    return may_grow && go_to(v, forest_.subdivide(v.element), p);
}

bool Descent::go_to(Visit& v, std::uint32_t first_child, Parameters p) const {
    if (first_child == none) return false;
    const bool triangle = v.geometry->is_triangle();
    const unsigned k = v.cell.child_at(p, triangle);
    enter(v, first_child + k, v.cell.child(k, triangle));
    return true;
}

void Descent::enter(Visit& v, std::uint32_t element, const Cell& cell) const {
    v.element = element;
    v.cell = cell;
    v.party.area = forest_.area(element);
    v.party.centre = v.geometry->point(cell.centre(v.geometry->is_triangle()));
    if (element >= old_size_) return;
    if (step_.carries_power()) v.radiosity = step_.radiosity[element];
    if (step_.oracle.by_importance) v.importance = step_.oracle.importance[element];
}

std::uint32_t Descent::old_leaf_at(const Visit& v, Parameters p) const {
    std::uint32_t e = v.element;
    if (e < old_size_) return forest_.leaf_below(e, v.cell, p, old_size_);
    while (e >= old_size_) e = forest_.parent(e);
    return e;
}

void Receiver::take(std::uint32_t s, std::span<const Ray> rays, std::span<const Parameters> origins,
                    std::span<const Hit> hits) {
    const ElementForest& forest = descent_.forest();
    Pair pair;
    pair.source = s;
    if (refines_) {
        pair.way = static_cast<std::uint32_t>(ways_.size());
        find_way_to_leaf(step_.leaves[s]);
        pair.way_end = static_cast<std::uint32_t>(ways_.size());
        pair.shooter = ways_[pair.way];
    }
    for (const Hit& hit : hits)
        if (hit.patch != none) forest.prefetch(hit.patch);
    for (std::size_t r = 0; r < rays.size(); ++r) {
        const std::uint32_t patch = hits[r].patch;
        if (patch == none) {
            for (std::size_t c = 0; c < 3; ++c) escaped_.power[c] += arrivals_.load(s)[c];
            ++escaped_.rays;
        } else if (!refines_ && forest.is_leaf(patch)) {
            sorter_.add(patch, s, true, true);
        } else {
            pair.patch = patch;
            pair.x = origins[r];
            pair.y = forest.geometry(patch).parameters_of(rays[r].origin + hits[r].distance * rays[r].direction);
            pair.receiver = descent_.root(patch);
            pair.reflectance = surfaces_.reflectance(patch);
            pairs_.push_back(pair);
        }
    }
}

void Receiver::finish_group() {
    if (refines_) find_receivers();
    for (const Pair& pair : pairs_) send(pair);
    pairs_.clear();
    ways_.clear();
}

Escaped Receiver::finish() {
    sorter_.hand_on_all();
    return std::exchange(escaped_, {});
}

/// Appends the elements that hold a leaf to ways_, from its root to itself.
void Receiver::find_way_to_leaf(std::uint32_t leaf) {
    const ElementForest& forest = descent_.forest();
    const std::uint32_t patch = forest.patch(leaf);
    const Parameters inside = forest.cell(leaf).centre(forest.geometry(patch).is_triangle());
    Visit v = descent_.root(patch);
    ways_.push_back(v);
    while (v.element != leaf) {
        descent_.go_down(v, inside);
        ways_.push_back(v);
    }
}

/// Walks every pair down from the roots until the oracle accepts it (Eq. 14, 15); the larger end is divided.
void Receiver::find_receivers() {
    open_.resize(pairs_.size());
    for (std::uint32_t i = 0; i < open_.size(); ++i) open_[i] = i;
    while (!open_.empty()) {
        std::size_t rejected = 0, divided = 0;
        for (const std::uint32_t i : open_) {  // no branch depends on the verdict
            open_[rejected] = i;
            rejected += !is_settled(pairs_[i]);
        }
        for (std::size_t k = 0; k < rejected; ++k) {
            const std::uint32_t i = open_[k];
            open_[divided] = i;
            divided += divide(pairs_[i]);
        }
        open_.resize(divided);
    }
}

/// Whether the oracle accepts the pair, or its larger end is too small to be divided.
bool Receiver::is_settled(const Pair& pair) const {
    const Party &shooter = pair.shooter.party, &receiver = pair.receiver.party;
    const bool small = std::max(shooter.area, receiver.area) < 4 * step_.oracle.smallest_area;
    return small |
           step_.oracle.accepts(shooter, receiver, pair.reflectance * pair.shooter.radiosity, pair.receiver.importance);
}

/// @return whether there was something to go down to.
bool Receiver::divide(Pair& pair) const {
    if (!(pair.shooter.party.area > pair.receiver.party.area)) return descent_.subdivide(pair.receiver, pair.y);
    if (pair.way + ++pair.depth >= pair.way_end) return descent_.subdivide(pair.shooter, pair.x);
    pair.shooter = ways_[pair.way + pair.depth];
    return true;
}

/// Sends power to the receiver, importance to the leaf or the patch that was hit.
void Receiver::send(const Pair& pair) {
    const bool to_leaf = !refines_ || (step_.carries_importance && !step_.importance_at_patches);
    const std::uint32_t leaf = to_leaf ? descent_.old_leaf_at(pair.receiver, pair.y) : pair.patch;
    const std::uint32_t of_power = refines_ ? pair.receiver.element : leaf;
    const std::uint32_t of_importance = step_.importance_at_patches ? pair.patch : leaf;
    const bool together = of_power == of_importance || !step_.carries_importance;
    if (step_.carries_power()) sorter_.add(of_power, pair.source, true, together);
    if (!step_.carries_power() || !together) sorter_.add(of_importance, pair.source, false, true);
}

}  // namespace interflect
