#include "interflect/solver/receiving.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace interflect {

/// Goes to the child that holds p, of the four from `first_child` on.
inline void Receiver::go_down(Place& place, std::uint32_t first_child, Parameters p, bool triangle) {
    const unsigned k = place.cell.child_at(p, triangle);
    place.cell = place.cell.child(k, triangle);
    place.element = first_child + k;
}

void Receiver::take(std::uint32_t leaf, const Arrivals::Load& load, std::span<const Ray> rays,
                    std::span<const Parameters> origins, std::span<const Hit> hits) {
    const std::uint32_t source = sorter_.add_source(load);
    bool way_is_known = false;
    for (std::size_t r = 0; r < rays.size(); ++r) {
        if (hits[r].patch == none) {
            for (std::size_t c = 0; c < 3; ++c) escaped_.power[c] += load[c];
            ++escaped_.rays;
        } else if (!refines_ && forest_.is_leaf(hits[r].patch)) {
            sorter_.add(hits[r].patch, source, true, true);
        } else {
            if (count_ == group_rays) {
                finish_group();
                way_is_known = false;
            }
            if (refines_ && !std::exchange(way_is_known, true)) find_way_to_leaf(leaf);
            add_pair(source, rays[r], origins[r], hits[r]);
        }
    }
}

void Receiver::prefetch(const Hit& hit) const {
    if (hit.patch == none) return;
    forest_.prefetch(hit.patch);
    if (!refines_) return;
    forest_.prefetch_geometry(hit.patch);
    surfaces_.prefetch(hit.patch);
    if (step_.oracle.by_importance) __builtin_prefetch(&step_.oracle.importance[hit.patch]);
}

void Receiver::finish_batch() {
    finish_group();
    sorter_.forget_sources();
}

Escaped Receiver::finish() {
    sorter_.hand_on_all();
    return std::exchange(escaped_, {});
}

/// Begins at the patches of both ends; the shooter's way is the last in ways_.
void Receiver::add_pair(std::uint32_t source, const Ray& ray, const Parameters& origin, const Hit& hit) {
    const std::size_t i = count_++;
    const PatchGeometry& geometry = forest_.geometry(hit.patch);
    Pair& pair = pairs_[i];
    pair.geometry = &geometry;
    pair.patch = hit.patch;
    pair.source = source;
    pair.x = origin;
    pair.y = geometry.parameters_of(ray.origin + hit.distance * ray.direction);
    pair.receiver = {hit.patch, Cell()};
    if (!refines_) return;
    parties_.receiver.normal.set(i, geometry.normal());
    parties_.reflectance.set(i, surfaces_.reflectance(hit.patch));
    parties_.importance[i] = 1;
    const Shooter& leaf = ways_.back();
    pair.way_end = static_cast<std::uint32_t>(ways_.size());
    pair.way = pair.way_end - 1 - static_cast<std::uint32_t>(forest_.level(leaf.place.element));
    pair.shooter = leaf.place;
    parties_.shooter.normal.set(i, leaf.party.normal);
    look_at_receiver(i);
}

/// Sends on what the group's rays carry, and begins a new one.
void Receiver::finish_group() {
    if (refines_) find_receivers();
    if (!refines_ || (step_.carries_importance() && !step_.importance_at_patches)) find_leaves();
    for (std::size_t i = 0; i < count_; ++i) send(pairs_[i]);
    count_ = 0;
    ways_.clear();
}

/// Appends the elements that hold a leaf to ways_, from its root to itself.
void Receiver::find_way_to_leaf(std::uint32_t leaf) {
    const std::uint32_t patch = forest_.patch(leaf), path = forest_.path(leaf);
    const PatchGeometry& geometry = forest_.geometry(patch);
    Place place{patch, Cell()};
    ways_.push_back(shooter_at(geometry, place));
    for (int digit = std::bit_width(path) - 3; digit >= 0; digit -= 2) {
        const unsigned k = path >> digit & 3u;
        place = {forest_.first_child(place.element) + k, place.cell.child(k, geometry.is_triangle())};
        ways_.push_back(shooter_at(geometry, place));
    }
}

Receiver::Shooter Receiver::shooter_at(const PatchGeometry& geometry, const Place& place) const {
    const V3f centre = geometry.point(place.cell.centre(geometry.is_triangle()));
    return {
        place, {centre, geometry.normal(), forest_.area(place.element)}, step_.light.radiosity(forest_, place.element)};
}

/// Lets the pair's shooter be the largest element that holds the ray's start and is no larger than the receiver, or the
/// leaf. Between larger ones and the receiver no verdict is asked for: what is received is the same for all of them.
void Receiver::choose_shooter(std::size_t i) {
    Pair& pair = pairs_[i];
    while (pair.way + 1 < pair.way_end && ways_[pair.way].party.area > parties_.receiver.area[i]) ++pair.way;
    const Shooter& shooter = ways_[pair.way];
    parties_.shooter.set(i, shooter.party.centre, shooter.party.area);
    const V3f reflectance = parties_.reflectance[i];
    parties_.reflected[i] = largest_channel(Rgb(reflectance * shooter.radiosity));
}

/// Walks every pair down from the roots until the oracle accepts it (Eq. 14, 15); the larger end is divided. No branch
/// depends on a verdict, and what is on the other end of a pointer is asked for before it is needed.
void Receiver::find_receivers() {
    std::size_t open = count_;
    std::iota(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(open), 0u);
    while (open > 0) {
        judge();
        std::size_t rejected = 0, divided = 0;
        for (std::size_t k = 0; k < open; ++k) {
            const std::uint32_t i = open_[k];
            open_[rejected] = i;
            rejected += parties_.settled[i] == 0;
        }
        for (std::size_t k = 0; k < rejected; ++k) {
            const std::uint32_t i = open_[k];
            const bool by_shooter = parties_.shooter.area[i] > parties_.receiver.area[i];  // and it is a leaf, or new
            open_[divided] = i;
            divided += by_shooter ? divide_shooter(i) : divide_receiver(i);
        }
        for (std::size_t k = 0; k < divided; ++k) look_at_receiver(open_[k]);
        open = divided;
    }
}

/// Whether the oracle accepts each pair of the group, or its larger end is too small to be divided. Those that have
/// been settled are judged again and again, since all of them at once take less time than a choice.
void Receiver::judge() {
    const Oracle& oracle = step_.oracle;
    const float smallest = 4 * oracle.smallest_area;
    const float *reflected = parties_.reflected.data(), *importance = parties_.importance.data();
    std::uint32_t* settled = parties_.settled.data();
    for (std::size_t i = 0; i < count_; ++i) {
        const Party shooter = parties_.shooter[i], receiver = parties_.receiver[i];
        const bool is_small = (shooter.area < smallest) & (receiver.area < smallest);
        const bool accepted = oracle.accepts(shooter, receiver, reflected[i], importance[i]);
        settled[i] = is_small | accepted;
    }
}

/// The receiver becomes its part that holds the hit; look_at_receiver() is due next. @return whether there is one.
bool Receiver::divide_receiver(std::size_t i) {
    Pair& pair = pairs_[i];
    const std::uint32_t child = children_of(pair.receiver.element);
    if (child == none) return false;
    go_down(pair.receiver, child, pair.y, pair.geometry->is_triangle());
    forest_.prefetch(pair.receiver.element);
    if (step_.oracle.by_importance) __builtin_prefetch(&step_.oracle.importance[pair.receiver.element]);
    return true;
}

/// Tells the oracle about the pair's receiver and the shooter that goes with it.
void Receiver::look_at_receiver(std::size_t i) {
    const Pair& pair = pairs_[i];
    const auto& [element, cell] = pair.receiver;
    parties_.receiver.set(i, pair.geometry->point(cell.centre(pair.geometry->is_triangle())), forest_.area(element));
    if (step_.oracle.by_importance && element < old_size_)  // a new element inherits
        parties_.importance[i] = step_.oracle.importance[element];
    if (pair.shooter.element < old_size_) choose_shooter(i);
}

/// The shooter, which is a leaf, becomes its part that holds the ray's start. @return whether there is one.
bool Receiver::divide_shooter(std::size_t i) {
    Pair& pair = pairs_[i];
    const PatchGeometry& geometry = forest_.geometry(forest_.patch(pair.shooter.element));
    const std::uint32_t child = children_of(pair.shooter.element);
    if (child == none) return false;
    go_down(pair.shooter, child, pair.x, geometry.is_triangle());
    const auto& [element, cell] = pair.shooter;
    parties_.shooter.set(i, geometry.point(cell.centre(geometry.is_triangle())), forest_.area(element));
    return true;
}

/// The first child; makes the children where there are none. @return none where it may not.
std::uint32_t Receiver::children_of(std::uint32_t element) {
    const std::uint32_t child = forest_.first_child(element);
    const bool may_grow = old_size_ + std::size_t{4} <= step_.oracle.most_elements;
    return child == none && may_grow ? forest_.subdivide(element) : child;
}

/// Finds the leaves, of those that were there when the step began, that hold the hits, from the receivers on.
void Receiver::find_leaves() {
    std::size_t open = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
        Place& leaf = pairs_[i].leaf;
        leaf = pairs_[i].receiver;
        while (leaf.element >= old_size_) leaf.element = forest_.parent(leaf.element);
        if (forest_.first_child(leaf.element) < old_size_) open_[open++] = i;
    }
    while (open > 0) {
        std::size_t inner = 0;
        for (std::size_t k = 0; k < open; ++k) {
            Pair& pair = pairs_[open_[k]];
            const std::uint32_t child = forest_.first_child(pair.leaf.element);
            go_down(pair.leaf, child, pair.y, pair.geometry->is_triangle());
            forest_.prefetch(pair.leaf.element);
        }
        for (std::size_t k = 0; k < open; ++k) {
            const std::uint32_t i = open_[k];
            open_[inner] = i;
            inner += forest_.first_child(pairs_[i].leaf.element) < old_size_;
        }
        open = inner;
    }
}

/// Sends power to the receiver, importance to the leaf or the patch that was hit.
void Receiver::send(const Pair& pair) {
    const std::uint32_t of_power = refines_ ? pair.receiver.element : pair.leaf.element;
    const std::uint32_t of_importance = step_.importance_at_patches ? pair.patch : pair.leaf.element;
    const bool together = of_power == of_importance || !step_.carries_importance();
    if (step_.carries_power()) sorter_.add(of_power, pair.source, true, together);
    if (!step_.carries_power() || !together) sorter_.add(of_importance, pair.source, false, true);
}

}  // namespace interflect
