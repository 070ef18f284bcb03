#include "interflect/solver/receiving.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numbers>
#include <utility>

namespace interflect {

void Receiver::take(std::uint32_t source, const Arrivals::Contribution& contribution,
                    std::span<const std::int64_t> of_groups, std::span<const Ray> rays,
                    std::span<const Parameters> origins, std::span<const Hit> hits) {
    const std::uint32_t carried = buffer_.add_source(contribution, of_groups);
    left_.push_back({source, 0});
    const auto left = static_cast<std::uint32_t>(left_.size() - 1);
    bool ancestors_are_known = !refines_;
    for (std::size_t r = 0; r < rays.size(); ++r) {
        if (hits[r].patch == none) {
            for (std::size_t c = 0; c < 3; ++c) escaped_.power[c] += contribution[c];
            ++escaped_.rays;
        } else if (!refines_ && forest_.is_leaf(hits[r].patch)) {
            buffer_.add(hits[r].patch, carried, true, true);
            if (gathered_) gather(left, hits[r].patch, hits[r].patch);
        } else {
            while (open_count_ == lanes) advance();
            if (refines_ && source >= old_size_)
                append_part(source - old_size_, rays[r], hits[r]);
            else if (!std::exchange(ancestors_are_known, true))
                append_ancestors(source);
            begin(carried, left, rays[r], origins[r], hits[r]);
        }
    }
}

void Receiver::prefetch(const Hit& hit) const {
    if (hit.patch == none) return;
    forest_.prefetch(hit.patch);
    if (!refines_) return;
    forest_.prefetch_geometry(hit.patch);
    materials_.prefetch(hit.patch);
    if (step_.oracle.by_importance) __builtin_prefetch(&step_.oracle.importance[hit.patch]);
}

void Receiver::finish_batch() {
    while (open_count_ > 0) advance();
    ancestors_.clear();
    buffer_.release_sources();
    if (gathered_)
        for (const auto& [source, found] : left_) gathered_->add(source, found);
    left_.clear();
}

Escaped Receiver::finish() {
    buffer_.flush_all();
    return std::exchange(escaped_, {});
}

/// Appends the elements that hold a leaf to ancestors_, from its root to itself.
void Receiver::append_ancestors(std::uint32_t leaf) {
    const std::uint32_t patch = forest_.patch(leaf), path = forest_.path(leaf);
    const PatchGeometry& geometry = forest_.geometry(patch);
    std::uint32_t element = patch;
    Cell cell;
    root_ancestor_ = static_cast<std::uint32_t>(ancestors_.size());
    for (int digit = std::bit_width(path) - 1;;) {
        const V3f centre = geometry.point(cell.centre(geometry.is_triangle()));
        ancestors_.push_back(
            {element, cell, centre, forest_.area(element), step_.light_for_oracle().of_element(patch, element)});
        if (digit == 0) break;
        digit -= 2;
        const unsigned k = path >> digit & 3u;
        element = forest_.first_child(element) + k;
        cell = cell.child(k, geometry.is_triangle());
    }
    leaf_ancestor_ = static_cast<std::uint32_t>(ancestors_.size() - 1);
}

/// A part of a luminaire is to the oracle a small disk that faces the ray, as bright as the part is where the ray
/// arrives.
void Receiver::append_part(std::uint32_t part, const Ray& ray, const Hit& hit) {
    constexpr float share_of_view = 1e-6f;  // so small that it is never the larger end of a pair
    constexpr float tiny = std::numeric_limits<float>::min();
    const float squared = std::max(hit.distance * hit.distance, tiny);
    const float area = std::max(share_of_view * std::min(squared, 4 * step_.oracle.min_area), tiny);
    Rgb radiosity = step_.emission->irradiance(part, hit.distance) * (std::numbers::pi_v<float> * squared / area);
    for (int c = 0; c < 3; ++c) radiosity[c] = std::min(radiosity[c], std::numeric_limits<float>::max());
    ancestors_.push_back({none, Cell(), ray.origin, area, radiosity});
    root_ancestor_ = leaf_ancestor_ = static_cast<std::uint32_t>(ancestors_.size() - 1);
}

/// Begins at the patches of both ends.
void Receiver::begin(std::uint32_t source, std::uint32_t left, const Ray& ray, const Parameters& start,
                     const Hit& hit) {
    const std::size_t i = open_[open_count_++];
    const PatchGeometry& geometry = forest_.geometry(hit.patch);
    const PatchGeometry::Shape& shape = geometry.shape();
    const Parameters p = geometry.parameters_of(ray.origin + hit.distance * ray.direction);
    rays_[i] = {source, hit.patch, left, start};
    pairs_.origin.set(i, shape.origin);
    pairs_.edge_u.set(i, shape.edge_u);
    pairs_.edge_v.set(i, shape.edge_v);
    pairs_.twist.set(i, shape.twist);
    pairs_.is_triangle[i] = geometry.is_triangle();
    pairs_.hit_u[i] = p.u;
    pairs_.hit_v[i] = p.v;
    pairs_.receiver[i] = pairs_.of_power[i] = hit.patch;
    pairs_.u[i] = pairs_.v[i] = 0;
    pairs_.size[i] = 1;
    pairs_.settled[i] = !refines_;
    if (!refines_) return;
    rays_[i].reflectance = materials_.reflectance(hit.patch);
    pairs_.normal.set(i, geometry.normal());
    pairs_.importance[i] = 1;
    pairs_.lowest_shooter[i] = leaf_ancestor_;
    set_shooter(i, root_ancestor_);
    const std::uint32_t shooter = ancestors_[root_ancestor_].element;
    pairs_.shooter_normal.set(i, shooter == none ? ray.direction : forest_.geometry(shooter).normal());
}

/// Takes all rays in flight one level further (Eq. 14, 15): of a pair that the oracle does not accept the larger end is
/// divided; when it does, power has arrived, and importance goes on to the leaf. No branch depends on a verdict.
void Receiver::advance() {
    Lanes some;
    for (const std::uint32_t i : open()) look_up_receiver(i);
    if (refines_) {
        for (const std::uint32_t i : open_lanes_if(some, [&](std::size_t i) { return shooter_is_too_large(i); }))
            choose_shooter(i);
        evaluate_oracle();
    }
    choose_next();
    for (const std::uint32_t i : open_lanes_if(some, [&](std::size_t i) { return pairs_.on_demand[i] != 0; }))
        subdivide_on_demand(i);
    const auto arrived = open_lanes_if(some, [&](std::size_t i) { return pairs_.goes_on[i] == 0; });
    Lanes on_their_way;
    const auto others = open_lanes_if(on_their_way, [&](std::size_t i) { return pairs_.goes_on[i] != 0; });
    for (const std::uint32_t i : arrived) send(i);
    std::copy(arrived.begin(), arrived.end(), std::copy(others.begin(), others.end(), open_.begin()));
    open_count_ = others.size();
    go_down();
    for (const std::uint32_t i : open()) {
        const std::uint32_t element = pairs_.receiver[i];
        forest_.prefetch(element);
        if (step_.oracle.by_importance) __builtin_prefetch(&step_.oracle.importance[element]);
    }
}

/// Of the lanes in use those for which `condition` holds, kept in `found`; without a branch.
template <class Condition>
inline std::span<const std::uint32_t> Receiver::open_lanes_if(Lanes& found, const Condition& condition) const {
    std::size_t count = 0;
    for (const std::uint32_t i : open()) {
        found[count] = i;
        count += condition(i);
    }
    return std::span(found).first(count);
}

/// Gets from the forest what the oracle asks about the receiver.
inline void Receiver::look_up_receiver(std::size_t i) {
    const std::uint32_t element = pairs_.receiver[i];
    pairs_.area[i] = forest_.area(element);
    pairs_.children[i] = forest_.first_child(element);
    if (step_.oracle.by_importance && element < old_size_)  // a new element inherits
        pairs_.importance[i] = step_.oracle.importance[element];
}

inline bool Receiver::shooter_is_too_large(std::size_t i) const {
    const float shooter = pairs_.shooter_area[i], receiver = pairs_.area[i];
    const std::uint32_t ancestor = pairs_.shooter[i], lowest = pairs_.lowest_shooter[i];
    return (shooter > receiver) & (ancestor < lowest);
}

/// Lets the pair's shooter be the largest element that holds the ray's start and is no larger than the receiver, or the
/// lowest. Between larger ones and the receiver no verdict is asked for: what is received is the same for all of them.
inline void Receiver::choose_shooter(std::size_t i) {
    std::uint32_t ancestor = pairs_.shooter[i] + 1;
    while (ancestor < pairs_.lowest_shooter[i] && ancestors_[ancestor].area > pairs_.area[i]) ++ancestor;
    set_shooter(i, ancestor);
}

inline void Receiver::set_shooter(std::size_t i, std::uint32_t ancestor) {
    const Shooter& shooter = ancestors_[ancestor];
    pairs_.shooter[i] = ancestor;
    pairs_.shooter_centre.set(i, shooter.centre);
    pairs_.shooter_area[i] = shooter.area;
    pairs_.reflected[i] = largest_channel(Rgb(rays_[i].reflectance * shooter.radiosity));
}

/// Whether the oracle accepts each pair, or its larger end is too small to be divided. Lanes that are not in use are
/// judged as well: all at once take less time than a choice.
void Receiver::evaluate_oracle() {
    const Oracle& oracle = step_.oracle;
    const float smallest = 4 * oracle.min_area;
    Pairs& p = pairs_;
    for (std::size_t i = 0; i < lanes; ++i) {
        const Cell cell{p.u[i], p.v[i], p.size[i]};
        const V3f centre = PatchGeometry::Shape{p.origin[i], p.edge_u[i], p.edge_v[i], p.twist[i]}.point(
            cell.centre(p.is_triangle[i] != 0));
        const ElementProxy shooter{p.shooter_centre[i], p.shooter_normal[i], p.shooter_area[i]};
        const ElementProxy receiver{centre, p.normal[i], p.area[i]};
        const bool is_small = (shooter.area < smallest) & (receiver.area < smallest);
        const bool accepted = oracle.accepts(shooter, receiver, p.reflected[i], p.importance[i]);
        p.settled[i] |= is_small | accepted;
    }
}

/// Decides what becomes of every pair, but for the special ones.
void Receiver::choose_next() {
    Pairs& p = pairs_;
    const float *shooter_area = p.shooter_area.data(), *area = p.area.data();
    const std::uint32_t old = needs_leaf_ ? old_size_ : 0;  // elements from there on are of no interest to importance
    for (std::size_t i = 0; i < lanes; ++i) {
        // Numbers of 32 bits, not bool, so that all vectors have lanes of one size.
        const std::uint32_t children = p.children[i], rejected = p.settled[i] ? 0 : 1;
        const std::uint32_t to_leaf = (p.receiver[i] < old ? 1 : 0) & (children < old ? 1 : 0);
        const std::uint32_t by_shooter = shooter_area[i] > area[i] ? 1 : 0;
        const std::uint32_t on_demand = rejected & ((children == none ? 1 : 0) | by_shooter);
        const std::uint32_t descends = rejected ? 1 - on_demand : to_leaf;
        p.on_demand[i] = on_demand;
        p.goes_on[i] = rejected | to_leaf;
        p.next[i] = descends ? children : none;
    }
}

/// Divides the larger end of a pair that was not accepted, if that is the shooter, which must be the lowest of its
/// ancestor, or a leaf. What cannot be divided is settled.
void Receiver::subdivide_on_demand(std::size_t i) {
    const std::uint32_t receiver = pairs_.receiver[i];
    if (pairs_.shooter_area[i] > pairs_.area[i]) {
        if (subdivide_shooter(i)) return;
    } else {
        pairs_.next[i] = children_of(receiver);
        if (pairs_.next[i] != none) return;
    }
    pairs_.settled[i] = true;
    pairs_.goes_on[i] = needs_leaf_ && receiver < old_size_ && pairs_.children[i] < old_size_;
    if (pairs_.goes_on[i]) pairs_.next[i] = pairs_.children[i];
}

/// The shooter becomes its part that holds the ray's start. @return whether there is one.
bool Receiver::subdivide_shooter(std::size_t i) {
    Shooter shooter = ancestors_[pairs_.shooter[i]];
    const PatchGeometry& geometry = forest_.geometry(forest_.patch(shooter.element));
    const std::uint32_t children = children_of(shooter.element);
    if (children == none) return false;
    const unsigned k = shooter.cell.child_at(rays_[i].start, geometry.is_triangle());
    shooter.cell = shooter.cell.child(k, geometry.is_triangle());
    shooter.element = children + k;
    shooter.centre = geometry.point(shooter.cell.centre(geometry.is_triangle()));
    shooter.area = forest_.area(shooter.element);
    ancestors_.push_back(shooter);
    pairs_.lowest_shooter[i] = static_cast<std::uint32_t>(ancestors_.size() - 1);
    set_shooter(i, pairs_.lowest_shooter[i]);
    return true;
}

/// The first child; makes the children where there are none. @return none where it may not.
std::uint32_t Receiver::children_of(std::uint32_t element) {
    const std::uint32_t child = forest_.first_child(element);
    const bool may_grow = old_size_ + std::size_t{4} <= step_.oracle.max_elements;
    return child == none && may_grow ? forest_.subdivide(element) : child;
}

/// Every receiver whose children are next becomes the one that holds the hit. No branch depends on which that is.
void Receiver::go_down() {
    Pairs& p = pairs_;
    for (std::size_t i = 0; i < lanes; ++i) {
        const bool goes = p.next[i] != none, triangle = p.is_triangle[i] != 0;
        const Cell cell{p.u[i], p.v[i], p.size[i]};
        const unsigned k = cell.child_at({p.hit_u[i], p.hit_v[i]}, triangle);
        const Cell child = cell.child(k, triangle);
        p.receiver[i] = goes ? p.next[i] + k : p.receiver[i];
        p.of_power[i] = p.settled[i] ? p.of_power[i] : p.receiver[i];
        p.u[i] = goes ? child.u : cell.u;
        p.v[i] = goes ? child.v : cell.v;
        p.size[i] = goes ? child.size : cell.size;
    }
}

/// Sends power to the receiver that was accepted, importance to the leaf or the patch that was hit.
void Receiver::send(std::size_t i) {
    const auto& [source, patch, left, start, reflectance] = rays_[i];
    std::uint32_t leaf = pairs_.receiver[i];
    while (leaf >= old_size_) leaf = forest_.parent(leaf);
    const std::uint32_t of_power = refines_ ? pairs_.of_power[i] : leaf;
    const std::uint32_t of_importance = step_.importance_at_patches ? patch : leaf;
    const bool together = of_power == of_importance || !step_.carries_importance();
    if (step_.carries_power()) buffer_.add(of_power, source, true, together);
    if (!step_.carries_power() || !together) buffer_.add(of_importance, source, false, true);
    if (gathered_) gather(left, patch, leaf);
}

inline void Receiver::gather(std::uint32_t left, std::uint32_t patch, std::uint32_t leaf) {
    left_[left].found += static_cast<double>(materials_.mean_reflectance(patch, leaf) * step_.importance[leaf]);
}

}  // namespace interflect
