#pragma once

#include <ImathVec.h>

#include <cstddef>
#include <vector>

#include "interflect/core.h"
#include "interflect/scene.h"

namespace interflect::testing_support {

using V3d = Imath::V3d;

/// A patch that is a rectangle, in double precision: corner + a u + b v for a, b in [0, 1], lit on the side of u x v.
struct Rectangle {
    V3d corner, u, v;
    V3d normal() const { return u.cross(v).normalized(); }
    double area() const { return u.cross(v).length(); }
};

/// Returns the patches of a scene that has only rectangles, in its order.
std::vector<Rectangle> rectangles_of(const Scene& scene);

/// F(i, j) of all pairs of patches: the fraction of the power leaving i that reaches j.
class FormFactors {
  public:
    explicit FormFactors(std::size_t patches) : patches_(patches), values_(patches * patches, 0.0) {}
    std::size_t patches() const { return patches_; }
    double& operator()(std::size_t from, std::size_t to) { return values_[from * patches_ + to]; }
    double operator()(std::size_t from, std::size_t to) const { return values_[from * patches_ + to]; }
    /// Returns the sum over all receivers: 1 minus the escaping share.
    double row_sum(std::size_t from) const;

  private:
    std::size_t patches_;
    std::vector<double> values_;
};

/// Computes the exact form factor between two unoccluded rectangles with edges parallel to the axes: the corner sums
/// C-13 and C-15 of Howell's catalogue (Ehlert and Smith 1993).
/// @throws std::logic_error if a rectangle lies on both sides of the other's plane, or an edge is not parallel to an
/// axis.
double form_factor(const Rectangle& from, const Rectangle& to);

/// form_factor of all pairs: valid for a scene without occlusion.
FormFactors exact_form_factors(const Scene& scene);

/// Computes the irradiance of every patch from Eq. 1 (Prikryl et al. 2000) as a dense linear system for each channel,
/// H = F (M + rho H), solved by Gaussian elimination.
std::vector<RgbD> dense_irradiance(const Scene& scene, const FormFactors& form_factors);

/// Computes the standard error of dense_irradiance if each row of `form_factors` was estimated by counting
/// `rays_per_row` independent rays. Noise dF of a row causes the error (I - F rho)^-1 dF B, to first order.
std::vector<RgbD> dense_irradiance_error(const Scene& scene, const FormFactors& form_factors, double rays_per_row);

}  // namespace interflect::testing_support
