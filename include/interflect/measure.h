/// @file
/// Light at points and on grids: irradiance, statistics of areas, glare, probes.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/shading.h"
#include "interflect/solve.h"

namespace interflect {

/// Shape of an infinitesimal receiver. Cylinders have no ends.
enum class Receiver {
    planar,
    cylindrical,      ///< A cylinder: measures the visibility of faces from all directions (EN 12464-1).
    semicylindrical,  ///< The half of a cylinder that faces one direction (CIE 136; EN 13201).
};

/// Position and receiver of a measurement.
struct MeasuringPoint {
    Imath::V3d position{0, 0, 0};  ///< World coordinates [m]. A point on a surface measures its irradiance.
    /// Planar: normal of the plane. Semicylindrical: facing direction, without its part along the axis. Need not be
    /// normalised.
    V3f normal{0, 0, 1};
    Receiver receiver = Receiver::planar;
    V3f axis{0, 0, 1};  ///< Axis of a cylinder; need not be normalised.
};

/// Irradiance at a measuring point [lux = lm/m^2, or W/m^2].
struct MeasuredIrradiance {
    Rgb direct{0, 0, 0};    ///< Light received straight from the sources.
    Rgb indirect{0, 0, 0};  ///< Light reflected at least once.
    /// Standard error of the sum from gathering alone, without the solution's own error.
    Rgb standard_error{0, 0, 0};
    float indirect_error = 0;  ///< Standard error of the mean over the channels of `indirect`.
    Rgb sum() const { return direct + indirect; }
    /// Whether the estimate is usable; false if an interruption left too few samples.
    bool is_measured() const { return std::isfinite(standard_error.x); }
    float illuminance() const { return luminance(sum()); }                 ///< [lux]
    float illuminance_error() const { return luminance(standard_error); }  ///< [lux]
};

/// Options of measure_irradiance() and rate_glare().
struct MeasuringOptions {
    Shading shading = Shading::gather;  ///< `gather` or `path`.
    int samples = 0;  ///< Paths per point, >= 2; the minimum if there is a target. 0: the number in default_samples.
    int max_samples = default_max_samples;  ///< Maximum number of paths per point with a target, >= samples.
    /// Target of the root mean square over the points of their standard error, relative to the mean irradiance of
    /// neighbours in the list or, if larger, of all points; >= 0; 0: no target. A single point stops by its own
    /// samples, which is slightly biased.
    double until = 0;
    /// Maximum duration [s], > 0. Every point gets two batches of paths, however long they take.
    double time = std::numeric_limits<double>::infinity();
    std::uint64_t seed = 1;
};

/// Measures irradiance by the methods of Shading. For cylinders, it is the mean over their normals (CIE 136).
/// @param solution  Of the same scene, as is `ray_caster`; may be null for Shading::path, which ignores it.
/// @return          One entry per point. Points with too few samples after an interruption have an infinite standard
///                  error.
/// @throws InputError for an option out of range, a solution or a ray caster of another scene, and for a point, normal
///         or axis that is not finite or has no direction.
std::vector<MeasuredIrradiance> measure_irradiance(const Scene& scene, const Solution* solution,
                                                   const RayCaster& ray_caster, std::span<const MeasuringPoint> points,
                                                   const MeasuringOptions& options = {}, const Monitor& monitor = {});

/// Upper limit of measuring points per grid.
inline constexpr std::size_t max_measuring_points = 1'000'000;

/// Maximum point distance of a measuring grid by EN 12464-1 (formula 1): p = 0.2 * 5^(log10 d) [m], at most 10 m. d is
/// the longer side of the area, or the shorter one if the longer is at least twice that.
/// @param length, width  Sides of the area [m], > 0.
double grid_spacing(double length, double width);

/// Layout of a grid.
struct GridOptions {
    std::optional<double> spacing{};  ///< Maximum point distance [m], > 0; nullopt: grid_spacing() of the area.
    double boundary = 0;              ///< Width of the excluded strip along the border of the area [m], >= 0.
};

/// The strip along walls that EN 12464-1 excludes from an area [m].
inline constexpr double usual_boundary = 0.5;

/// Coplanar faces, on or above which light is measured.
struct PlanarArea {
    std::string name;                 ///< Name of the object that contains the faces.
    V3f normal{0, 0, 1};              ///< Unit normal, towards the lit side.
    std::vector<PatchIndex> patches;  ///< The faces, as indices into Scene::patches.
    double area = 0;                  ///< Area of the faces [m^2].
};

/// Finds the planar surface of an object: its faces in the plane with the largest total area. Includes nested objects:
/// "desk" includes "desk.top". Two-sided faces count by their front, unless `facing` decides.
/// @param facing  Direction within 10 degrees of the surface's normal; nullopt: any.
/// @throws InputError for an unknown object, with the nearest names; if no face matches; and if several planes are
///         (nearly) equally large, with their normals.
PlanarArea find_surface(const Scene& scene, const std::string& object, const std::optional<V3f>& facing = {});

/// Finds the largest horizontal plane of an object's upward faces, such as the top of a desk; the highest of equal
/// planes.
/// @throws InputError as find_surface() does.
PlanarArea find_top(const Scene& scene, const std::string& object);

/// Finds the floor at or below a height: the upward faces of the scene in the horizontal plane with the largest total
/// area.
/// @param height  World z [m].
/// @throws InputError if no such face exists.
PlanarArea find_floor(const Scene& scene, double height);

/// Divides an area by the objects of its faces, ordered by size. Copies of an array ("floor.a0", "floor.a1.2" in MGF)
/// count as one object. Excludes objects that lie within larger ones, such as undersides of furniture on a floor.
std::vector<PlanarArea> divide_by_object(const Scene& scene, const PlanarArea& area);

/// Points to measure at.
struct MeasuringGrid {
    std::string name;
    std::vector<Imath::V3d> points{};            ///< World coordinates [m]; for an area row by row.
    V3f normal{0, 0, 1};                         ///< Normal of the area, unit length.
    int columns = 0, rows = 0;                   ///< Cells of the rectangle around the area; 0 for lines and points.
    double column_spacing = 0, row_spacing = 0;  ///< Distances between points [m]; lines use the first.
    Imath::V3d corner{0, 0, 0};                  ///< Corner of the first cell [m].
    Imath::V3d along_row{1, 0, 0}, along_column{0, 1, 0};  ///< Unit vectors from cell to cell.
    std::vector<std::uint32_t> cells{};                    ///< row * columns + column of each point.
    std::size_t enclosed = 0;                              ///< Points that without_enclosed_points() removed.
};

/// Creates a grid on an area, or at a given height. The smallest rectangle around the area, less the boundary strip, is
/// divided into the fewest equal cells no wider than the spacing. A cell's centre is a point of the grid if it lies
/// within the faces, at least the strip's width from their border.
/// @param height  World z of the points [m]; nullopt: on the area itself.
/// @throws InputError for options out of range, for more than max_measuring_points, and if no point remains. Cost:
///         O(points * patches), with a boundary also O(patches^2).
MeasuringGrid area_grid(const Scene& scene, const PlanarArea& area, const GridOptions& options = {},
                        const std::optional<double>& height = {});

/// Removes the points of an area inside furniture and other solids: points inside one-sided faces, and points from
/// which random walks of 16 segments, reflected diffusely by every face, reach no source of light and do not leave the
/// scene. If all points are enclosed, all remain: the room has no light.
/// @param ray_caster  Of the same scene. Cost: about 70 rays a point, 2,000 a removed point.
/// @return            The grid with `enclosed` set; grids without columns (lines, points) are unchanged.
MeasuringGrid without_enclosed_points(const Scene& scene, const RayCaster& ray_caster, MeasuringGrid grid);

/// Returns `count` equidistant points from a to b, inclusive.
/// @throws InputError for fewer than 2 points, for more than max_measuring_points, and for equal ends.
MeasuringGrid line_grid(const Imath::V3d& a, const Imath::V3d& b, int count);

/// Statistics of the illuminance at the points of a measuring area [lx].
struct IlluminanceSummary {
    std::size_t points = 0;
    double mean = 0, min = 0, max = 0;
    double mean_error = 0;  ///< Standard error of the mean from sampling, which is independent at each point.
    double min_error = 0;   ///< Standard error of the minimum.
    double mean_solution_error = 0, min_solution_error = 0;  ///< Additional errors from the solution.

    double uniformity() const { return mean > 0 ? min / mean : 0; }  ///< U0 = Emin / Emean (EN 12665).
    double diversity() const { return max > 0 ? min / max : 0; }     ///< Ud = Emin / Emax.
};

/// Standard errors of gathered light due to the solution, in addition to sampling errors.
struct SolutionError {
    double mean = 0;      ///< Error of the mean over the measuring area [lx].
    double relative = 0;  ///< Error of each point, relative to its indirect illuminance.
    double at(const MeasuredIrradiance& point) const { return relative * luminance(point.indirect); }
};

/// Estimates the solution's error from points that are also measured by path tracing with other random numbers. With
/// the differences d, their sampling variances v, and the indirect illuminances E of n of N points:
///         relative^2 = max(sum (d^2 - v), sqrt(sum v^2 / 2)) / sum E^2
///         mean^2     = max(d_mean^2, sum v / (2 n^2)) + (1 - n / N) relative^2 sum E^2 / n^2
/// The lower bounds are half the resolution of the comparison. In 144 solutions of four scenes the true mean was within
/// two errors (sampling and solution) in 98.6% of cases, at least 92% in every scene; points in 97.1%.
/// @param gathered  All points.
/// @param chosen    Indices of the points of `traced`, in the same order.
/// @return          NaN if no chosen point was measured in both ways.
SolutionError estimate_solution_error(std::span<const MeasuredIrradiance> gathered, std::span<const std::size_t> chosen,
                                      std::span<const MeasuredIrradiance> traced);

IlluminanceSummary summarise(std::span<const MeasuredIrradiance> measured, const SolutionError& solution_error = {});

/// Returns the unobstructed horizontal illuminance outside, from the scene's skies without its sun [lx], which is the
/// reference of daylight factors; nullopt without a sky.
std::optional<double> exterior_illuminance(const Scene& scene);

/// Returns whether the scene has other light sources than skies, including the sun. Illuminance over
/// exterior_illuminance() is then not a daylight factor.
bool has_other_light_than_sky(const Scene& scene);

/// Position and gaze of an observer.
struct Observer {
    Imath::V3d eye{0, 0, 0};     ///< World coordinates [m].
    V3f line_of_sight{1, 0, 0};  ///< Need not be normalised.
};

/// Visible part of a light source: emitting patches of an object, or a measured luminaire.
struct GlareSource {
    std::string name;           ///< Name of the object or the luminaire; for patches outside objects, of the material.
    double luminance = 0;       ///< Mean luminance of the visible part [cd/m^2].
    double solid_angle = 0;     ///< Solid angle omega of the visible part [sr].
    double position_index = 1;  ///< Mean index p: L^2 omega / p^2 equals `glare` for uniform luminance.
    double glare = 0;           ///< Integral of L^2 / p^2 over the solid angle [cd^2 sr / m^4].
    bool is_rated = true;       ///< False outside the table of position indices; UGR then excludes the source.
};

/// Unified Glare Rating for an observer.
struct GlareRating {
    double ugr = -std::numeric_limits<double>::infinity();  ///< Minus infinity without visible sources.
    double standard_error = 0;                              ///< Standard error of `ugr`, due to the background.
    double background_luminance = 0;                        ///< Background luminance Lb [cd/m^2].
    /// Visible sources: rated sources first, both kinds in order of decreasing glare.
    std::vector<GlareSource> sources{};
};

/// Returns the position index p of Guth, as fitted by Levin (1975). It is 1 on the line of sight, increases away from
/// it, and is equal for mirror images above and below it. Directions need not be normalised.
/// @param towards            Direction of the source.
/// @param line_of_sight, up  Need not be perpendicular.
/// @return  Infinity for directions not in front of the observer.
double position_index(const V3f& towards, const V3f& line_of_sight, const V3f& up = V3f(0, 0, 1));

/// Whether CIE 117:1995 tabulates the position index of a direction: H / R <= 1.9 and T / R <= 3 with R > 0. R, H and T
/// are the components along the line of sight, along the vertical perpendicular to it, and across both.
/// @param towards            Direction of the source; need not be normalised.
/// @param line_of_sight, up  As for position_index().
bool has_position_index(const V3f& towards, const V3f& line_of_sight, const V3f& up = V3f(0, 0, 1));

/// Returns UGR = 8 log10(0.25 / Lb * sum of L^2 omega / p^2) over the rated sources (CIE 117:1995).
/// @param background_luminance  Lb [cd/m^2]; if it is 0 and sources are visible, the result is infinity.
double unified_glare_rating(double background_luminance, std::span<const GlareSource> sources);

/// Computes the visible light sources by quadrature over their areas, with a ray to each node: emitting patches with L
/// = M / pi, measured luminaires with L = I(d) / A(d), where A is the projected area of the luminous opening. A
/// luminaire is rated as a whole if has_position_index() holds for its centre; a patch is rated by its cells, and an
/// object that is partly within the table appears twice. Excludes sources without area (point and spot lights,
/// luminaires without opening), the sun and skies. Includes emitting windows, although UGR was not designed for them.
/// The z axis is up.
/// @param ray_caster  Of the same scene. Cost: 4 to 256 rays an emitting patch, 64 a luminaire.
/// @throws InputError for a line of sight without direction.
std::vector<GlareSource> glare_sources(const Scene& scene, const RayCaster& ray_caster, const Observer& observer);

/// Computes the glare rating of each observer. Lb is the indirect illuminance at the eye of a plane perpendicular to
/// the line of sight, over pi.
/// @param solution  As in measure_irradiance(), as are `options` and `monitor`.
/// @return          One rating per observer. Observers not reached before an interruption have a non-finite standard
///                  error.
std::vector<GlareRating> rate_glare(const Scene& scene, const Solution* solution, const RayCaster& ray_caster,
                                    std::span<const Observer> observers, const MeasuringOptions& options = {},
                                    const Monitor& monitor = {});

/// Returns the real spherical harmonics of degree 0, 1 and 2 in a unit direction, orthonormal over the sphere: Y00,
/// Y1-1, Y10, Y11, Y2-2, Y2-1, Y20, Y21, Y22. The signs are those of Ramamoorthi and Hanrahan 2001: Y1-1, Y10 and Y11
/// increase with y, z and x.
std::array<float, 9> spherical_harmonics(const V3f& direction);

/// Irradiance of small surfaces at a point, as a function of their normal.
struct IrradianceProbe {
    /// E_lm [lm/m^2 or W/m^2], the projection of E(n) on the harmonics: the coefficients of radiance times pi, 2 pi / 3
    /// and pi / 4 for degree 0, 1 and 2 (Ramamoorthi and Hanrahan 2001, Eq. 9). The omitted higher degrees are at most
    /// 9.4% of the irradiance from one direction.
    std::array<Rgb, 9> coefficients;
    /// Standard error of irradiance() from sampling and from the number of facets, root mean square over all normals,
    /// mean over the channels; without the solution's own error.
    float standard_error = 0;
    /// Whether the probe is inside a solid or in the dark: more than a quarter of all directions hit the back of a
    /// one-sided face, or no light arrives. Exclude such probes from interpolation.
    bool is_inside = false;

    IrradianceProbe() { coefficients.fill(Rgb(0)); }
    /// Returns the irradiance for a unit normal. It may be slightly negative for light from few directions.
    Rgb irradiance(const V3f& normal) const;
};

struct ProbeOptions {
    float spacing = 1;  ///< Maximum spacing of the grid [m], > 0.
    int rays = 2048;    ///< Gathered directions per probe, 8 to 2^20; at least 256 are used.
    std::uint64_t seed = 1;
};

/// Probes at the centres of equal cells that fill the scene's bounding box.
struct ProbeGrid {
    Imath::V3d first{0, 0, 0};            ///< Position of the lowest probe, in world coordinates [m].
    Imath::V3d step{0, 0, 0};             ///< Distance of neighbours along each axis [m].
    std::array<int, 3> count{};           ///< Number of probes along each axis.
    std::vector<IrradianceProbe> probes;  ///< Ordered by z, then y, then x; x varies fastest.

    Imath::V3d position(std::size_t probe) const;  ///< World coordinates [m].
};
/// Maximum number of probes of one grid.
inline constexpr std::int64_t max_probes = 1'000'000;

/// Measures the light of probes in a solution as measure_irradiance() does, at 128 points for each probe: the facets of
/// a small ball, in a random rotation. The coefficients are unbiased except for the solution's error from the second
/// bounce on. For light from a single direction, degree 1 is exact, and the facets give irradiance() an error of 0.18%
/// of the light (root mean square over normals and rotations; at most 1.3%).
/// @param ray_caster  Of the same scene, as is `solution`.
/// @return            The same bits for any number of threads.
/// @throws InputError for an option out of range, more than max_probes, or another scene; Stopped if `monitor` ends
///         it.
ProbeGrid irradiance_probes(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                            const ProbeOptions& options = {}, const Monitor& monitor = {});

/// Fault of the place of a measuring point.
enum class PointFault {
    sound,    ///< No fault.
    outside,  ///< Outside the scene: a quarter of its front directions leave a closed room.
    behind    ///< Inside a solid: most rays first pass the back of a one-sided face.
};

/// Finds points outside of the scene and inside solids. Traces 32 rays and their reversed rays for at most 2048 evenly
/// spaced points.
std::vector<PointFault> point_faults(const Scene& scene, const RayCaster& ray_caster,
                                     std::span<const MeasuringPoint> points);

}  // namespace interflect
