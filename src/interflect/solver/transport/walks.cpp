#include "interflect/solver/transport/walks.h"

#include <cmath>
#include <span>

#include "interflect/base/numbers/random.h"
#include "interflect/solver/sampling/ray_maker.h"

namespace interflect::detail {

namespace {

enum class VertexPurpose : std::uint64_t { survival = 1, reflection = 2 };

std::uint64_t sub_key(std::uint64_t key, VertexPurpose purpose, std::uint64_t index) {
    return mix(mix(key, static_cast<std::uint64_t>(purpose)), index);
}

}  // namespace

Walks::Walks(const Materials& materials, const ElementForest& forest, const RayCaster& ray_caster, const Panes& panes,
             const TransportStep& step, const ContributionUnits& units, std::uint32_t elements, std::uint64_t key)
    : materials_(materials),
      forest_(forest),
      ray_caster_(ray_caster),
      panes_(panes),
      step_(step),
      units_(units),
      elements_(elements),
      key_(key) {}

void Walks::add(const Ray& ray, const Hit& hit, const RgbD& power, const Rgb& transmittance, Walkers& walkers) const {
    const Parameters at = forest_.geometry(hit.patch).parameters_of(ray.origin + hit.distance * ray.direction);
    const ElementIndex leaf = forest_.leaf_at(hit.patch, at, elements_);
    walkers.received.push_back({leaf, hit.patch, at, power * RgbD(transmittance), channel_sum(power)});
}

void Walks::follow(std::uint64_t task, Walkers& walkers, Descent& descent) const {
    const std::uint64_t survival = sub_key(key_, VertexPurpose::survival, task);
    const std::uint64_t reflection = sub_key(key_, VertexPurpose::reflection, task);
    for (std::uint64_t bounce = 0; !walkers.received.empty(); ++bounce) {
        survive(random_double(survival, bounce), walkers);
        shoot(mix(reflection, bounce), walkers);
        receive(walkers, descent);
    }
    descent.finish_task();
}

/// Applies Russian roulette. The survival probability p of a particle is the reflected share of its ray's power, all
/// channels together. Divides the power of survivors by p.
void Walks::survive(double offset, Walkers& walkers) const {
    const std::size_t groups = step_.groups.size();
    walkers.reflected.clear();
    walkers.reflected_groups.clear();
    double cumulative = offset;
    for (std::size_t i = 0; i < walkers.received.size(); ++i) {
        ReflectedPower particle = walkers.received[i];
        const RgbD rho(materials_.surface(particle.patch, particle.leaf).reflectance);
        const double share = particle.of_ray > 0 ? channel_sum(rho * particle.power) / particle.of_ray : 0;
        const double last = std::floor(cumulative);
        cumulative += share;
        if (std::floor(cumulative) == last) continue;
        particle.power = rho * particle.power / share;
        walkers.reflected.push_back(particle);
        for (std::size_t g = 0; g < groups; ++g)
            walkers.reflected_groups.push_back(rho * walkers.received_groups[i * groups + g] / share);
    }
}

/// Samples the reflected rays. They start at the hit point if the leaf reflects there, else uniformly on the leaf.
void Walks::shoot(std::uint64_t key, Walkers& walkers) const {
    walkers.rays.resize(walkers.reflected.size());
    for (std::size_t i = 0; i < walkers.rays.size(); ++i) {
        const auto& [leaf, patch, at, power, of_ray] = walkers.reflected[i];
        const PatchGeometry& geometry = forest_.geometry(patch);
        const float offset = ray_caster_.ray_offset(patch);
        Parameters start;
        shoot_rays(geometry, forest_.cell(leaf), offset, PointSet::random, key, i, walkers.points,
                   std::span(&walkers.rays[i], 1), std::span(&start, 1));
        if (step_.reflects_where_received(leaf))
            walkers.rays[i].origin = geometry.point(at) + geometry.normal() * offset;
    }
}

void Walks::receive(Walkers& walkers, Descent& descent) const {
    walkers.hits.resize(walkers.rays.size());
    ray_caster_.trace(walkers.rays, walkers.hits);
    panes_.trace(walkers.rays, walkers.hits, walkers.behind);
    walkers.received.clear();
    walkers.received_groups.clear();
    for (std::size_t i = 0; i < walkers.rays.size(); ++i)
        deposit(walkers.rays[i], walkers.hits[i], Rgb(1), i, walkers, descent);
    for (const auto& [ray, transmittance, hit] : walkers.behind)
        deposit(walkers.rays[ray], hit, transmittance, ray, walkers, descent);
}

void Walks::deposit(const Ray& ray, const Hit& hit, const Rgb& transmittance, std::size_t walker, Walkers& walkers,
                    Descent& descent) const {
    const std::size_t groups = step_.groups.size();
    const RgbD power = walkers.reflected[walker].power * RgbD(transmittance);
    const Contribution contribution = units_.contribution_of(power);
    if (hit.patch == none) return descent.count_escaped(contribution);
    walkers.group_terms.clear();
    for (std::size_t g = 0; g < groups; ++g) {
        const RgbD of_group = walkers.reflected_groups[walker * groups + g] * RgbD(transmittance);
        const FixedPoint::Value terms = units_.power.from(of_group);
        walkers.group_terms.insert(walkers.group_terms.end(), terms.begin(), terms.end());
        walkers.received_groups.push_back(of_group);
    }
    add(ray, hit, walkers.reflected[walker].power, transmittance, walkers);
    descent.deposit_at(walkers.received.back().leaf, contribution, walkers.group_terms);
}

}  // namespace interflect::detail
