/// The parts of the module `interflect._core`, and their common functions.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "docstrings.h"
#include "documented.h"
#include "interflect/image.h"
#include "interflect/interflect.h"
#include "vectors.h"

namespace interflect::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_scene_parts(py::module_& module);
void bind_light_sources(py::module_& module);
void bind_scene(py::module_& module);
void bind_files(py::module_& module);
void bind_solution(py::module_& module);
void bind_solver(py::module_& module);
void bind_pictures(py::module_& module);
void bind_measurements(py::module_& module);
void bind_view_factors(py::module_& module);

/// A scene with its light and its ray caster: `interflect.Solution`.
class Light {
  public:
    Light(std::shared_ptr<const Scene> s, std::shared_ptr<const Solution> light,
          std::shared_ptr<const RayCaster> caster)
        : scene(std::move(s)), solution(std::move(light)), ray_caster(std::move(caster)) {}

    const std::shared_ptr<const Scene> scene;
    const std::shared_ptr<const Solution> solution;
    const std::shared_ptr<const RayCaster> ray_caster;

    /// Returns the result of leaves(), which the first call computes.
    const std::vector<Leaf>& mesh() const {
        std::call_once(made_, [this] { mesh_ = leaves(*scene, *solution); });
        return mesh_;
    }

  private:
    mutable std::once_flag made_;
    mutable std::vector<Leaf> mesh_;
};
using SharedLight = std::shared_ptr<Light>;

/// Removes const, because pybind11 has no const objects. The bindings of `T` have no member that changes it.
template <class T>
std::shared_ptr<T> without_const(std::shared_ptr<const T> object) {
    return std::const_pointer_cast<T>(std::move(object));
}

/// Returns a read-only array over memory that `owner` keeps alive.
/// @param strides  Distances between entries along each dimension [bytes].
template <class Number>
py::array read_only(std::shared_ptr<const void> owner, const Number* first, const std::vector<py::ssize_t>& shape,
                    const std::vector<py::ssize_t>& strides) {
    auto* kept = new std::shared_ptr<const void>(std::move(owner));
    const py::capsule base(kept, [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
    py::array result(py::dtype::of<Number>(), shape, strides, first, base);
    py::detail::array_proxy(result.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return result;
}

/// Returns a read-only array of a member of each structure in a vector, with a row of `columns` numbers per structure,
/// or one number if `columns` is 0.
template <class Number, class Structure, class Member>
py::array column(std::shared_ptr<const void> owner, const std::vector<Structure>& rows, Member Structure::*member,
                 py::ssize_t columns = 0) {
    static const Structure nothing{};
    const Structure& first = rows.empty() ? nothing : rows.front();
    const auto* start = reinterpret_cast<const Number*>(&(first.*member));
    const auto count = static_cast<py::ssize_t>(rows.size());
    constexpr auto stride = static_cast<py::ssize_t>(sizeof(Structure)),
                   inner = static_cast<py::ssize_t>(sizeof(Number));
    if (columns == 0) return read_only(std::move(owner), start, {count}, {stride});
    return read_only(std::move(owner), start, {count, columns}, {stride, inner});
}

/// Returns a read-only array of a vector of numbers, colours, points or coordinates, with a row per entry.
template <class Number, class T>
py::array rows(std::shared_ptr<const void> owner, const std::vector<T>& values) {
    static const T nothing{};
    const auto* start = reinterpret_cast<const Number*>(values.empty() ? &nothing : values.data());
    const auto count = static_cast<py::ssize_t>(values.size());
    constexpr auto stride = static_cast<py::ssize_t>(sizeof(T)), inner = static_cast<py::ssize_t>(sizeof(Number));
    if constexpr (sizeof(T) == sizeof(Number)) return read_only(std::move(owner), start, {count}, {stride});
    return read_only(std::move(owner), start, {count, stride / inner}, {stride, inner});
}

/// Returns a picture as a float32 array (height, width, 3), which owns the pixels.
py::array_t<float> array_of(Image image);

/// Returns the filter of the keyword `denoise`: False or None, True for "auto", or a label of Denoiser.
std::optional<Denoiser> denoiser_of(const py::object& denoise);
/// Sets INTERFLECT_OIDN, unless it is set, to the library of the Python package pyoidn if that is installed.
void name_library_of_pyoidn();
/// @param name  Name of the argument, for messages.
/// @throws InputError unless the array has the shape (height, width, 3).
Image image_of(const py::array_t<float, py::array::c_style | py::array::forcecast>& array, const std::string& name);

/// Converts a number of samples for the library: None, the default number, becomes 0.
/// @throws InputError for a number below 1.
int samples_of(const std::optional<int>& samples);
/// Inverse of samples_of().
inline std::optional<int> optional_samples(int samples) { return samples > 0 ? std::optional(samples) : std::nullopt; }

/// Returns one sentence per warning.
std::vector<std::string> sentences(const Warnings& warnings);
/// Reports warnings by warnings.warn(). @param stack_level  1: caller of the C++ function.
void warn(const Warnings& warnings, int stack_level);

/// Returns the view of that name, or the given view itself.
View view_of(const Scene& scene, const py::object& view);
/// Also accepts None: the scene's first view, or an overview.
View view_or_overview(const Scene& scene, const RayCaster& ray_caster, const py::object& view, int threads);

}  // namespace interflect::python
