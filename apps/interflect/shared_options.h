#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/parse.h"
#include "interflect/formats/load_scene.h"
#include "interflect/scene/scene.h"
#include "interflect/solver/solve.h"

namespace interflect::command {

/// Which scene, and how to read it.
struct SceneOptions {
    std::filesystem::path path;
    ReadOptions read;

    void add_to(CLI::App& app, const std::string& what = "Scene file (.mgf), or maze:ROOMS[:furniture]");
    /// Loads it and logs its warnings.
    Scene load() const;
};

/// How finely a scene is divided before a method that does not refine by itself.
struct MeshOptions {
    float size = automatic_mesh_size;  ///< [m], or one of the two words of parse_mesh_size.

    void add_to(CLI::App& app);
    Scene divide(Scene scene, const ReadOptions& read) const;
};

/// From where to look.
struct ViewOptions {
    std::vector<std::string> names;
    std::vector<std::filesystem::path> files;
    std::optional<V3f> eye, look_at;
    V3f up{0, 0, 1};
    float fov = 45;

    void add_to(CLI::App& app);
    /// The views that were asked for; empty where none was. @throws InputError for one that is not there or shows
    /// nothing.
    std::vector<View> views(const Scene& scene) const;
};

/// How to solve.
struct SolverOptions {
    SolveOptions solve;
    std::string method = "srr";
    int threads = 0;  ///< 0: as many as the machine has.
    std::filesystem::path stats;

    void add_to(CLI::App& app);
    /// Solve options, with the default of rays removed where only another limit was given.
    SolveOptions resolved() const;

  private:
    CLI::Option* rays_ = nullptr;
};

void add_threads(CLI::App& app, int& threads);

/// Logs what was counted while a scene was read.
void log_warnings(const Warnings& warnings);

}  // namespace interflect::command
