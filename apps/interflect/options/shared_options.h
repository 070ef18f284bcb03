#pragma once

#include <CLI/CLI.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/interflect/values/distinct_files.h"
#include "apps/interflect/values/parse.h"
#include "interflect/load.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::command {

inline constexpr const char* daylight_group = "Daylight";

inline constexpr const char* scene_formats = "Scene file (.gltf, .glb, .obj, .ply, .stl, .rad, .vs3, .mgf)";

struct SceneOptions {
    std::filesystem::path path;
    ReadOptions read;
    std::vector<PlacedLuminaire> luminaires;
    Daylight daylight;

    void add_to(CLI::App& app, const std::string& what = scene_formats);
    /// @param traces_paths  As for refuse_scene_options().
    /// @throws UsageError for invalid daylight and for options without effect on a solution or a maze.
    void check(const CLI::App& command, bool traces_paths = false) const;
    /// @param needs_light  Whether the absence of light sources is worth a warning.
    Scene load(bool needs_light = true) const;

  private:
    void add_daylight_to(CLI::App& app);
    void check_daylight(const CLI::App& command) const;
    Daylight placed_daylight() const;

    Imath::V3d zenith_{0, 0, 1};
};

struct MeshOptions {
    bool contact_cuts = true;
    float size = automatic_mesh_size;  ///< [m], automatic_mesh_size or whole_patches.

    void add_to(CLI::App& app);
    /// Cuts faces where others meet them, unless switched off.
    Scene cut(Scene scene, const ReadOptions& read) const;
    /// Cuts the scene, then divides patches to the mesh size.
    /// @param refines  Whether the method divides patches itself; `auto` then leaves them whole.
    Scene divide(Scene scene, const ReadOptions& read, bool refines) const;
};

struct ViewOptions {
    std::vector<std::string> names;
    std::vector<std::filesystem::path> files;
    std::optional<Imath::V3d> eye, look_at;  // world coordinates
    V3f up{0, 0, 1};
    float fov = 45;

    void add_to(CLI::App& app);
    /// Adds all options but --up, for a command that has its own.
    void add_without_up(CLI::App& app);
    /// Number of requested views.
    std::size_t count() const { return names.size() + files.size() + (eye ? 1 : 0); }
    /// @throws UsageError if --eye, --look-at and --up give no picture.
    void check() const;
    /// @throws InputError for a view that is missing or shows no picture.
    std::vector<View> views(const Scene& scene) const;

  private:
    View view_of_eye() const { return {"command line", *eye, *look_at, up, fov}; }
};

std::vector<NamedFile> input_files(const SceneOptions& scene, const ViewOptions& view);

/// Headings in the help.
inline constexpr const char* reading_group = "Reading the scene";
inline constexpr const char* view_group = "View";
inline constexpr const char* solver_group = "Solver";
inline constexpr const char* limits_group = "Limits";
inline constexpr const char* refinement_group = "Refinement";
inline constexpr const char* importance_group = "Importance";
inline constexpr const char* experimental_group = "Experimental (of the paper, and for comparison with it)";
/// Headings that only --help-all shows.
inline constexpr std::array<std::string_view, 5> rare_groups = {reading_group, solver_group, refinement_group,
                                                                importance_group, experimental_group};

void add_limits(CLI::App& app, GivenLimits& limits);

struct SolverOptions {
    int threads = 0;         ///< Number of threads; 0 for all threads of the machine.
    std::size_t memory = 0;  ///< Limit of the process's memory [bytes]; 0 for 9/10 of the machine's memory.
    std::filesystem::path stats;

    void add_to(CLI::App& app);
    /// Returns the options of solve(). @param aspect  Width over height of the pictures.
    SolveOptions resolved(const std::vector<View>& views, float aspect = 16.0f / 9, int pixel_rows = 720) const;
    /// Whether the method divides patches itself.
    /// @param has_views  Whether rays concentrate on views. The default method depends on it.
    bool method_refines(bool has_views) const;
    std::uint64_t seed() const { return given_.others.seed; }
    double until() const { return given_.limits.limits().until; }  ///< Target of the relative error; 0 if not given.
    double time() const { return given_.limits.limits().time; }    ///< [s]; infinite if not given.

  private:
    void add_refinement(CLI::App& app);
    void add_importance(CLI::App& app);
    void add_schedule(CLI::App& app);
    void add_paper_refinement(CLI::App& app);
    void add_paper_importance(CLI::App& app);

    GivenSettings given_;
};

void add_method(CLI::App& app, std::optional<Method>& method);

void add_threads(CLI::App& app, int& threads);

/// @param omitted  Kind of warnings that are not logged.
void log_warnings(const Warnings& warnings, std::string_view omitted = {});

}  // namespace interflect::command
