#include "interflect/solver/deposit/descent.h"

#include <algorithm>
#include <utility>

namespace interflect::detail {

void Descent::deposit(std::uint32_t source, const Contribution& contribution,
                      std::span<const std::int64_t> power_by_group, std::span<const Ray> rays,
                      std::span<const Parameters> origins, std::span<const Hit> hits, float transmitted) {
    const std::uint32_t payload = buffer_.add_payload(contribution, power_by_group);
    sources_in_task_.push_back({source, 0, transmitted});
    const auto source_in_task = static_cast<std::uint32_t>(sources_in_task_.size() - 1);
    bool has_path = false;  // all rays of a leaf share a path
    for (std::size_t r = 0; r < rays.size(); ++r) {
        if (hits[r].patch == none) {
            count_escaped(contribution);
        } else if (!refines_ && forest_.is_leaf(hits[r].patch)) {
            buffer_.add(hits[r].patch, payload, Terms::both);  // terms that the ray does not carry are 0
            if (step_.reflects_where_received(hits[r].patch)) {
                const V3f point = rays[r].origin + hits[r].distance * rays[r].direction;
                add_start_point(hits[r].patch, forest_.geometry(hits[r].patch).parameters_of(point), contribution);
            }
            if (found_importance_) add_found_importance(source_in_task, hits[r].patch, hits[r].patch);
        } else {
            while (active_count_ == lanes) advance();
            const bool is_luminaire_part = source >= old_size_;
            if (refines_ && is_luminaire_part)
                path_ = source_paths_.append_part(source - old_size_, rays[r], hits[r]);
            else if (refines_ && !std::exchange(has_path, true))
                path_ = source_paths_.append_leaf(ElementIndex(source));
            begin(payload, source_in_task, rays[r], origins[r], hits[r]);
        }
    }
}

void Descent::prefetch(const Hit& hit) const {
    if (hit.patch == none) return;
    forest_.prefetch(hit.patch);
    if (!refines_) return;
    forest_.prefetch_geometry(hit.patch);
    materials_.prefetch(hit.patch);
    if (step_.oracle.by_importance) __builtin_prefetch(&step_.oracle.importance[hit.patch]);
}

void Descent::finish_task() {
    while (active_count_ > 0) advance();
    source_paths_.clear();
    buffer_.release_payloads();
    if (found_importance_)
        for (const auto& [source, found, transmitted] : sources_in_task_)
            found_importance_->add(source, found * double{transmitted});
    sources_in_task_.clear();
}

Escaped Descent::finish() {
    buffer_.flush_all();
    return std::exchange(escaped_, {});
}

void Descent::begin(std::uint32_t payload, std::uint32_t source_in_task, const Ray& ray, const Parameters& start,
                    const Hit& hit) {
    const std::size_t i = active_[active_count_++];
    const PatchGeometry& geometry = forest_.geometry(hit.patch);
    const PatchGeometry::Shape& shape = geometry.shape();
    const Parameters p = geometry.parameters_of(ray.origin + hit.distance * ray.direction);
    rays_[i] = {payload, hit.patch, source_in_task, start};
    pairs_.patch_origin.set(i, shape.origin);
    pairs_.edge_u.set(i, shape.edge_u);
    pairs_.edge_v.set(i, shape.edge_v);
    pairs_.twist.set(i, shape.twist);
    pairs_.is_triangle[i] = geometry.is_triangle();
    pairs_.hit_u[i] = p.u;
    pairs_.hit_v[i] = p.v;
    pairs_.receiver[i] = pairs_.power_receiver[i] = hit.patch;
    pairs_.u[i] = pairs_.v[i] = 0;
    pairs_.size[i] = 1;
    pairs_.settled[i] = !refines_;
    if (!refines_) return;
    rays_[i].reflectance = materials_.reflectance(hit.patch);
    pairs_.normal.set(i, geometry.normal());
    pairs_.importance[i] = 1;
    source_paths_.begin(pairs_, i, path_, rays_[i].reflectance);
}

/// Moves all rays in flight one level down. Pairs that the oracle rejects are divided at the larger end (Eq. 14, 15,
/// Prikryl et al. 2000). An accepted pair determines the receiver of power. Rays that deposit importance on leaves then
/// continue to their leaf.
void Descent::advance() {
    Lanes selected, kept;
    for (const std::uint32_t i : active()) look_up_receiver(i);
    if (refines_) {
        for (const std::uint32_t i :
             active_lanes_if(selected, [&](auto i) { return SourcePaths::shooter_is_too_large(pairs_, i); }))
            source_paths_.choose_shooter(pairs_, i, rays_[i].reflectance);
        pairs_.evaluate_oracle(step_.oracle);
    }
    pairs_.choose_next(needs_leaf_, old_size_);
    for (const std::uint32_t i :
         active_lanes_if(selected, [&](std::size_t i) { return pairs_.needs_children[i] != 0; }))
        provide_children(i);
    const auto arrived = active_lanes_if(selected, [&](std::size_t i) { return pairs_.continues[i] == 0; });
    const auto continuing = active_lanes_if(kept, [&](std::size_t i) { return pairs_.continues[i] != 0; });
    for (const std::uint32_t i : arrived) deposit_ray(i);
    std::copy(arrived.begin(), arrived.end(), std::copy(continuing.begin(), continuing.end(), active_.begin()));
    active_count_ = continuing.size();
    pairs_.descend();
    for (const std::uint32_t i : active()) {
        const ElementIndex element(pairs_.receiver[i]);
        forest_.prefetch(element);
        if (step_.oracle.by_importance)
            __builtin_prefetch(step_.oracle.importance.data() + element);  // addresses beyond the array are harmless
    }
}

template <class Condition>
inline std::span<const std::uint32_t> Descent::active_lanes_if(Lanes& found, const Condition& condition) const {
    std::size_t count = 0;
    for (const std::uint32_t i : active()) {
        found[count] = i;
        count += condition(i);
    }
    return std::span(found).first(count);
}

inline void Descent::look_up_receiver(std::size_t i) {
    const ElementIndex element(pairs_.receiver[i]);
    pairs_.area[i] = forest_.area(element);
    pairs_.children[i] = forest_.first_child(element);
    if (step_.oracle.by_importance && element < old_size_)  // new elements have the importance of their ancestor
        pairs_.importance[i] = step_.oracle.importance[element];
}

void Descent::provide_children(std::size_t i) {
    const ElementIndex receiver(pairs_.receiver[i]);
    if (pairs_.shooter_area[i] > pairs_.area[i]) {
        if (source_paths_.subdivide(pairs_, i, rays_[i].start, rays_[i].reflectance, may_grow_)) return;
    } else {
        pairs_.next[i] = find_or_create_children(forest_, receiver, may_grow_);
        if (pairs_.next[i] != none) return;
    }
    pairs_.settled[i] = true;  // the pair is indivisible, but importance continues to a leaf of the old mesh
    pairs_.continues[i] = needs_leaf_ && receiver < old_size_ && pairs_.children[i] < old_size_;
    if (pairs_.continues[i]) pairs_.next[i] = pairs_.children[i];
}

void Descent::deposit_ray(std::size_t i) {
    const auto& [payload, patch, source_in_task, start, reflectance] = rays_[i];
    ElementIndex old_receiver(pairs_.receiver[i]);
    while (old_receiver >= old_size_) old_receiver = forest_.parent(old_receiver);
    const ElementIndex power_receiver = refines_ ? ElementIndex(pairs_.power_receiver[i]) : old_receiver;
    const ElementIndex importance_receiver = step_.importance_at_patches ? patch : old_receiver;
    if (step_.carries_power() && step_.carries_importance() && power_receiver == importance_receiver) {
        buffer_.add(power_receiver, payload, Terms::both);
    } else {
        if (step_.carries_power()) buffer_.add(power_receiver, payload, Terms::power);
        if (step_.carries_importance()) buffer_.add(importance_receiver, payload, Terms::importance);
    }
    if (found_importance_) add_found_importance(source_in_task, patch, old_receiver);
    if (step_.reflects_where_received(old_receiver))
        add_start_point(old_receiver, {pairs_.hit_u[i], pairs_.hit_v[i]}, buffer_.contribution(payload));
}

void Descent::add_start_point(ElementIndex leaf, const Parameters& at, const Contribution& contribution) {
    // The power remains in fixed-point units, because StartPoints uses only ratios.
    const auto power = static_cast<float>(contribution[0] + contribution[1] + contribution[2]);
    if (power > 0) start_points_.push_back({leaf, power, at});
}

inline void Descent::add_found_importance(std::uint32_t source_in_task, PatchIndex patch, ElementIndex element) {
    sources_in_task_[source_in_task].found +=
        static_cast<double>(materials_.mean_reflectance(patch, element) * step_.importance[element]);
}

}  // namespace interflect::detail
