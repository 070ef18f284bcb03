/// @file
/// Colours, errors, warnings, progress and random points.
#pragma once

#include <ImathColor.h>
#include <ImathVec.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace interflect {

/// Linear Rec. 709 colour, or any quantity per channel in the unit of that quantity.
using Rgb = Imath::Color3f;
/// Double precision, for sums over many patches.
using RgbD = Imath::Color3<double>;
using V3f = Imath::V3f;

/// Rec. 709 luminance. Photometric quantities keep their unit: luminance({1, 1, 1}) == 1.
template <class T>
constexpr T luminance(const Imath::Color3<T>& c) {
    return T(0.2126) * c.x + T(0.7152) * c.y + T(0.0722) * c.z;
}

/// Sum of the channels, used for sampling probabilities so that every channel is sampled.
template <class T>
constexpr T channel_sum(const Imath::Color3<T>& c) {
    return c.x + c.y + c.z;
}

template <class T>
constexpr T largest_channel(const Imath::Color3<T>& c) {
    return std::max({c.x, c.y, c.z});
}

template <class T>
bool is_finite(const Imath::Vec3<T>& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

/// One fault of an input.
struct Fault {
    std::string text;  ///< A sentence for the user, with the expected and the found value, without the file.
    /// Name of the material, light, view, texture or object at fault, or "patch 3"; or empty.
    std::string object = {};
    /// Name of an option that is wrong or too strict, such as that of ReadOptions::max_patches; or empty.
    std::string setting = {};
    std::filesystem::path file = {};  ///< Empty if no file applies.
    std::int64_t line = 0;            ///< 1-based; 0 if no line applies.
};

/// Invalid user input: a file, an argument, a scene. The command line tool exits with code 3.
class InputError : public std::runtime_error {
  public:
    /// The message becomes "file:line: text".
    explicit InputError(Fault fault);
    explicit InputError(const std::string& text) : InputError(Fault{text}) {}
    /// @param line  1-based; 0 if no line applies.
    InputError(const std::filesystem::path& file, std::int64_t line, const std::string& text)
        : InputError(Fault{.text = text, .file = file, .line = line}) {}
    /// @param message  Lists the faults. @param faults  At least one.
    InputError(const std::string& message, std::vector<Fault> faults)
        : std::runtime_error(message), faults_(std::move(faults)) {}

    /// All faults of a scene or of a plan, at least one.
    const std::vector<Fault>& faults() const { return faults_; }
    /// The first fault, usually the only one.
    const Fault& fault() const { return faults_.front(); }

  private:
    std::vector<Fault> faults_;
};

/// Valid but unsupported input, with one counted entry per kind.
class Warnings {
  public:
    struct Entry {
        std::string kind;     ///< Stable identifier, such as "unsupported-entity"; several messages may share it.
        std::string message;  ///< One sentence for the user.
        std::string where;    ///< "file:line" of the first occurrence; may be empty.
        std::int64_t count = 0;
    };

    /// Counts one more occurrence of (kind, message); keeps the first `where`.
    void add(const std::string& kind, const std::string& message, const std::string& where = {});
    const std::vector<Entry>& entries() const { return entries_; }  ///< In order of first occurrence.

  private:
    std::vector<Entry> entries_;
};

/// Source of the four random numbers of a ray.
enum class PointSet {
    sobol,   ///< Owen-scrambled Sobol' points, one sequence per source. The error decreases faster than N^-1/2.
    random,  ///< Pseudo-random (Philox). The error decreases like N^-1/2.
};

struct IterationReport;

/// Progress of a run, a picture or a measurement.
struct Progress {
    std::int64_t rays = 0;  ///< Rays of all kinds so far.
    double fraction = 0;    ///< Fraction of the work planned so far, in [0, 1]; a missed target adds work.
    /// Estimated relative error so far; NaN if unknown.
    double relative_error = std::numeric_limits<double>::quiet_NaN();
    const IterationReport* iteration = nullptr;  ///< The last iteration of a run of the solver; null for other work.
};

class Ranks;
struct Rendering;

/// Progress reports and early termination of long work, and the processes that share it.
struct Monitor {
    /// Called on the calling thread: after each iteration of the solver, or several times a second. May be empty.
    std::function<void(const Progress&)> on_progress;
    /// Once true, the work ends within milliseconds. May be set by another thread or a signal handler; may be null.
    const std::atomic<bool>* stop = nullptr;
    /// Processes that share a run of the solver, each with the same call; null: this process alone. Only the first
    /// process reads `stop`, which then ends the work within some seconds. Pictures, measurements and exports need
    /// null, except in the command, which shares them.
    Ranks* ranks = nullptr;
    /// Receives an unfinished picture from render() in hybrid shading, on the calling thread: once, after the first
    /// samples of every pixel, if more may follow. May be empty.
    std::function<void(const Rendering&)> on_picture = {};
};

/// Thrown if Monitor::stop ends work before it has a usable result. The message names the missing part.
class Stopped : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace interflect
