#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "interflect/base/files/state_archive.h"
#include "interflect/solution.h"

namespace interflect::detail {

struct SavedRun {
    SolvedScene solved;  ///< Its sources are undimmed; apply Solution::dimming.
    StateArchive state;
};

/// Reads a saved run. @throws InputError as read_solution() does, or if the state is missing or of another version.
SavedRun read_saved_run(const std::filesystem::path& path);

/// Returns the name of the scene of a saved run; an empty name for other files. Does not verify checksums.
std::string scene_of_saved_run(const std::filesystem::path& path);

/// Reads the bytes of solution_image(). @throws std::runtime_error
SavedRun read_saved_image(std::span<const char> image);
SolvedScene read_solution_image(std::span<const char> image);

/// Writes a solution file, with the state of its run unless `state` is null. Throws as the public write_solution()
/// does.
void write_solution(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                    const StateArchive* state);

/// Makes a solution without light, with which a solution file can store a scene that is not solved.
Solution dark_solution(const Scene& scene);

/// Returns the bytes of a solution file without checksums.
std::string solution_image(const Scene& scene, const Solution& solution, const StateArchive* state);

}  // namespace interflect::detail
