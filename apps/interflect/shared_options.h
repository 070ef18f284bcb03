#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/distinct_files.h"
#include "apps/interflect/parse.h"
#include "interflect/load_scene.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::command {

/// Where the help lists skies and the sun.
inline constexpr const char* daylight_group = "Daylight";

/// For the help.
inline constexpr const char* scene_formats = "Scene file (.gltf, .glb, .obj, .ply, .stl, .rad, .mgf)";

/// Which scene, and how to read it.
struct SceneOptions {
    std::filesystem::path path;
    ReadOptions read;
    std::vector<PlacedLuminaire> luminaires;
    Daylight daylight;

    void add_to(CLI::App& app, const std::string& what = std::string(scene_formats) + ", or maze:ROOMS[:furniture]");
    /// Loads it and logs its warnings.
    Scene load() const;

  private:
    void add_daylight_to(CLI::App& app);

    Imath::V3d zenith_{0, 0, 1};
};

/// How a scene is divided before it is solved.
struct MeshOptions {
    bool contact_cuts = true;
    float size = automatic_mesh_size;  ///< [m], or one of the two words of parse_mesh_size.

    void add_to(CLI::App& app);
    /// Cuts faces where others meet them, unless that is switched off, and logs the warnings of that.
    Scene cut(Scene scene, const ReadOptions& read) const;
    /// Cuts the scene, then divides patches to the mesh size.
    /// @param refines  Whether the method divides patches itself: then `auto` leaves them whole.
    Scene divide(Scene scene, const ReadOptions& read, bool refines) const;
};

/// From where to look.
struct ViewOptions {
    std::vector<std::string> names;
    std::vector<std::filesystem::path> files;
    std::optional<Imath::V3d> eye, look_at;  // in the world
    V3f up{0, 0, 1};
    float fov = 45;

    void add_to(CLI::App& app);
    /// The views that were asked for; empty where none was. @throws InputError for one that is not there or shows
    /// nothing.
    std::vector<View> views(const Scene& scene) const;
};

/// The files that these name.
std::vector<NamedFile> input_files(const SceneOptions& scene, const ViewOptions& view);

/// Where the help lists the options of solving; `render --shading path` has none of these.
inline constexpr const char* solver_group = "Solver";
inline constexpr const char* limits_group = "Limits";
inline constexpr const char* refinement_group = "Refinement";
inline constexpr const char* importance_group = "Importance";
inline constexpr const char* experimental_group =
    "Experimental (the paper's switches, and what is measured against them)";

/// When a run ends.
struct LimitOptions {
    std::optional<std::int64_t> rays;
    std::optional<double> time, until;

    void add_to(CLI::App& app);
    bool any() const { return rays || time || until; }
    /// Unlimited by what was not given.
    Limits resolved() const;
};

/// How to solve.
struct SolverOptions {
    int threads = 0;         ///< 0: as many as the machine has.
    std::size_t memory = 0;  ///< Limit of the process [bytes]; 0: nine tenths of the machine's.
    std::filesystem::path stats;

    void add_to(CLI::App& app);
    /// What solve() is to be asked for. Where no method was named it is ihsrr if something is looked at, else hsrr; the
    /// default limit goes where another was given.
    /// @param aspect  Width over height of the pictures.
    SolveOptions resolved(const std::vector<View>& views, float aspect = 16.0f / 9, int pixel_rows = 720) const;
    std::uint64_t seed() const { return solve_.seed; }
    double until() const { return limits_.resolved().until; }  ///< Target of the relative error; 0: none was given.

  private:
    void add_refinement(CLI::App& app);
    void add_importance(CLI::App& app);
    void add_schedule(CLI::App& app);
    void add_paper_refinement(CLI::App& app);
    void add_paper_importance(CLI::App& app);

    SolveOptions solve_;
    LimitOptions limits_;
    std::optional<Method> method_;
    std::optional<ImportanceUse> importance_;
};

/// How to solve, where it is named.
void add_method(CLI::App& app, std::optional<Method>& method);

void add_threads(CLI::App& app, int& threads);

/// Logs what was counted while a scene was read.
void log_warnings(const Warnings& warnings);

}  // namespace interflect::command
