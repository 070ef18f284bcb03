#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "interflect/base/files/input_file.h"
#include "interflect/base/files/state_archive.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/hdf5/checksums.h"
#include "interflect/exports/hdf5/hdf5_arrays.h"
#include "interflect/exports/records/description.h"
#include "interflect/exports/records/json_text.h"
#include "interflect/exports/records/solve_report.h"
#include "interflect/exports/records/texture_records.h"
#include "interflect/exports/saved_run.h"
#include "interflect/solution.h"

namespace interflect {

using namespace detail;

namespace {

/// Versions of the format. Version 3 adds the origin, contacts and surfaces of patches; version 4 checksums, options
/// and the result; version 5 all iterations; version 6 direct light; version 7 the largest payload of iterations;
/// version 8 unreduced irradiance.
constexpr int format_version = 8, oldest_format_version = 2, first_with_history = 5, first_with_checksums = 4,
              first_with_contacts = 3;
constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";

template <class Vector>
std::vector<float> flattened(const std::vector<Vector>& v) {
    std::vector<float> numbers;
    numbers.reserve(3 * v.size());
    for (const Vector& c : v) numbers.insert(numbers.end(), {c.x, c.y, c.z});
    return numbers;
}

template <class Vector>
std::vector<Vector> grouped(const std::vector<float>& numbers) {
    std::vector<Vector> v(numbers.size() / 3);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = Vector(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
    return v;
}

/// Four vertices, material, object, other side and, since version 3, surface.
constexpr std::size_t numbers_per_patch = 8;

std::vector<std::uint32_t> patch_numbers(const Scene& scene) {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(numbers_per_patch * scene.patches.size());
    for (const Patch& p : scene.patches) {
        numbers.insert(numbers.end(), p.vertices.begin(), p.vertices.end());
        numbers.insert(numbers.end(), {p.material, p.object, p.other_side, p.surface});
    }
    return numbers;
}

PerPatch<Patch> patches_of(const std::vector<std::uint32_t>& numbers, std::size_t columns) {
    PerPatch<Patch> patches(numbers.size() / columns);
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const auto* n = &numbers[columns * i];
        std::copy_n(n, 4, patches[i].vertices.begin());
        patches[i].material = n[4];
        patches[i].object = n[5];
        patches[i].other_side = PatchIndex(n[6]);
        if (columns == numbers_per_patch) patches[i].surface = n[7];
    }
    return patches;
}

std::vector<V3f> contact_ends(const Scene& scene) {
    std::vector<V3f> ends;
    for (const Contact& c : scene.contacts) ends.insert(ends.end(), {c.a, c.b});
    return ends;
}

std::vector<Contact> contacts_of(const std::vector<V3f>& ends) {
    if (ends.size() % 2 != 0) throw std::runtime_error("a contact has no end");
    std::vector<Contact> contacts(ends.size() / 2);
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i] = {ends[2 * i], ends[2 * i + 1]};
    return contacts;
}

std::shared_ptr<ElementForest> forest_of(const Scene& scene, const std::vector<std::uint32_t>& parents) {
    const std::size_t size = scene.patches.size() + 4 * parents.size();
    if (size >= none) throw std::runtime_error("too many elements");
    auto forest = std::make_shared<ElementForest>(scene, size);
    forest->rebuild(std::vector<ElementIndex>(parents.begin(), parents.end()));
    return forest;
}

struct ElementNumbers {
    const char* dataset;
    const char* name;
    std::vector<float> Solution::*values;
    bool needs_view;
    int since_version;
};
constexpr std::array<ElementNumbers, 5> element_numbers = {
    {{"/solution/standard_error", "standard error", &Solution::standard_error, false, 2},
     {"/solution/discretisation_error", "discretisation error", &Solution::discretisation_error, false, 3},
     {"/solution/rays", "number of rays", &Solution::rays, false, 2},
     {"/solution/view_importance", "view importance", &Solution::view_importance, true, 2},
     {"/solution/indirect_importance", "indirect importance", &Solution::indirect_importance, true, 2}}};

/// Returns the first fault of the numbers; "" if they are valid.
std::string fault_of(std::span<const float> numbers, std::size_t per_element, const ElementForest& forest,
                     const char* what) {
    if (numbers.size() != per_element * forest.size()) return fmt::format("{} and elements differ in number", what);
    const auto is_wrong = [](float number) { return !std::isfinite(number) || number < 0; };
    const auto first = std::find_if(numbers.begin(), numbers.end(), is_wrong);
    if (first == numbers.end()) return "";
    return fmt::format("the {} of element {} is negative or not finite ({} such numbers)", what,
                       static_cast<std::size_t>(first - numbers.begin()) / per_element,
                       std::count_if(first, numbers.end(), is_wrong));
}

void require_none(const std::string& fault) {
    if (!fault.empty()) throw std::runtime_error(fault);
}

void require_valid(const Scene& scene) {
    for (const Fault& fault : scene_faults(scene)) require_none(fault.text);
}

void require_valid(const Solution& solution) {
    const ElementForest& forest = *solution.forest;
    const auto* irradiance = reinterpret_cast<const float*>(solution.irradiance.data());
    require_none(fault_of({irradiance, 3 * solution.irradiance.size()}, 3, forest, "irradiance"));
    if (!solution.unreduced_irradiance.empty()) {
        const auto* unreduced = reinterpret_cast<const float*>(solution.unreduced_irradiance.data());
        const std::size_t numbers = 3 * solution.unreduced_irradiance.size();
        require_none(fault_of({unreduced, numbers}, 3, forest, "unreduced irradiance"));
    }
    for (const ElementNumbers& n : element_numbers)
        if (!n.needs_view || !solution.view_importance.empty())
            require_none(fault_of(solution.*n.values, 1, forest, n.name));
    for (const std::vector<Rgb>& of_group : solution.groups) {
        const auto* numbers = reinterpret_cast<const float*>(of_group.data());
        require_none(fault_of({numbers, 3 * of_group.size()}, 3, forest, "irradiance by a light group"));
    }
    for (const std::vector<Rgb>& part : solution.direct) {
        const auto* numbers = reinterpret_cast<const float*>(part.data());
        require_none(fault_of({numbers, 3 * part.size()}, 3, forest, "direct irradiance"));
    }
    if (!is_finite(solution.emitted_power)) require_none("the emitted power is not finite");
}

bool has_hdf5_signature(const std::filesystem::path& path, std::uint64_t offset) {
    std::string begin(hdf5_signature.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(offset));
    return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == hdf5_signature;
}

void read_scene_arrays(const Hdf5Reader& file, int version, Scene& scene) {
    scene.vertices = grouped<V3f>(file.read<float>("/scene/vertices", 3));
    const bool has_contacts = version >= first_with_contacts;
    const std::size_t columns = has_contacts ? numbers_per_patch : numbers_per_patch - 1;
    scene.patches = patches_of(file.read<std::uint32_t>("/scene/patches", columns), columns);
    if (has_contacts) scene.contacts = contacts_of(grouped<V3f>(file.read<float>("/scene/contacts", 3)));
    read_textures(file, scene);
}

constexpr const char* history_dataset = "/history";

std::vector<double> history_numbers(const Solution& solution) {
    std::vector<double> numbers;
    for (const IterationReport& report : solution.iterations) {
        const std::vector<double> row = report_row(report);
        numbers.insert(numbers.end(), row.begin(), row.end());
    }
    return numbers;
}

/// Reads the history. If it is not empty, it replaces the report of the last iteration.
void read_history(const Hdf5Reader& file, Solution& solution) {
    const std::size_t columns = report_columns().size();
    const std::vector<double> numbers = file.read<double>(history_dataset, columns);
    if (numbers.empty()) return;
    solution.iterations.clear();
    for (std::span<const double> left = numbers; !left.empty(); left = left.subspan(columns))
        solution.iterations.push_back(report_of_row(left.first(columns)));
}

constexpr const char* unreduced_dataset = "/solution/unreduced_irradiance";

std::string group_dataset(std::size_t group) { return fmt::format("/solution/groups/{}", group); }

std::string direct_dataset(std::size_t part) { return fmt::format("/solution/direct/{}", part); }

void read_direct(const Hdf5Reader& file, Solution& solution) {
    if (!file.has("/solution/direct")) return;
    for (std::size_t part = 0; part < std::max<std::size_t>(1, solution.groups.size()); ++part)
        solution.direct.push_back(grouped<Rgb>(file.read<float>(direct_dataset(part), 3)));
}

void read_groups(const Hdf5Reader& file, SolvedScene& solved) {
    Solution& solution = solved.solution;
    const std::size_t named = solved.scene.light_groups.size();  // sources without a group may form one more group
    const bool has_names =
        solution.group_names.size() == named || (named > 0 && solution.group_names.size() == named + 1);
    if (!has_names || solution.dimming.size() != solution.group_names.size())
        throw std::runtime_error("light groups, their names and their dimming differ in number");
    for (const float factor : solution.dimming)
        if (!(factor >= 0 && std::isfinite(factor)))
            throw std::runtime_error("the dimming of a light group is no factor");
    source_groups(solved.scene);  // throws InputError
    for (std::size_t g = 0; g < solution.group_names.size(); ++g)
        solution.groups.push_back(grouped<Rgb>(file.read<float>(group_dataset(g), 3)));
}

void apply_dimming(SolvedScene& solved) {
    std::vector<float>& dimming = solved.solution.dimming;
    if (std::all_of(dimming.begin(), dimming.end(), [](float factor) { return factor == 1; })) return;
    solved.scene = dimmed(solved.scene, source_groups(solved.scene), dimming);
    std::fill(dimming.begin(), dimming.end(), 1.0f);
}

void read_solution_arrays(const Hdf5Reader& file, int version, bool has_importance, SolvedScene& solved) {
    Solution& solution = solved.solution;
    solution.forest = forest_of(solved.scene, file.read<std::uint32_t>("/elements/subdivided"));
    solution.irradiance = grouped<Rgb>(file.read<float>("/solution/irradiance", 3));
    if (file.has(unreduced_dataset))
        solution.unreduced_irradiance = grouped<Rgb>(file.read<float>(unreduced_dataset, 3));
    for (const ElementNumbers& n : element_numbers) {
        if (n.needs_view && !has_importance) continue;
        if (version < n.since_version)
            (solution.*n.values).assign(solution.forest->size(), 0.0f);
        else
            solution.*n.values = file.read<float>(n.dataset);
    }
    read_groups(file, solved);
    read_direct(file, solution);
    if (version >= first_with_history) read_history(file, solution);
    IterationReport& last = solution.iterations.back();
    last.elements = solution.forest->size();
    // Each subdivision adds four elements and replaces one leaf by four.
    last.leaves = last.elements - (last.elements - solution.forest->patch_count()) / 4;
}

struct VerifiedFile {
    bool has_checksums;  // also true for a file in memory
    Hdf5Reader arrays;
};

VerifiedFile verified(const std::filesystem::path& path) {
    // Files without checksums begin with the signature.
    const bool has_checksums = !has_hdf5_signature(path, 0);
    if (has_checksums) verify_checksums(path);
    return {has_checksums, Hdf5Reader(path)};
}

SolvedScene read_solved_scene(const VerifiedFile& file) {
    SolvedScene solved;
    const std::vector<char> text = file.arrays.read<char>("/description");
    const bool has_importance =
        read_description({text.data(), text.size()}, oldest_format_version, format_version, solved);
    if (!file.has_checksums && solved.format_version >= first_with_checksums)
        throw std::runtime_error("the file is damaged: its checksums are missing");
    read_scene_arrays(file.arrays, solved.format_version, solved.scene);
    require_valid(solved.scene);
    read_solution_arrays(file.arrays, solved.format_version, has_importance, solved);
    require_valid(solved.solution);
    return solved;
}

std::vector<FileRange> write_arrays(Hdf5Writer& file, const std::string& description, const Scene& scene,
                                    const Solution& solution) {
    const auto write = [&]<class T>(const char* name, const std::vector<T>& numbers, std::size_t columns) {
        return file.write(name, std::span<const T>(numbers), columns);
    };
    const std::vector<ElementIndex> subdivided = solution.forest->subdivided();
    std::vector<FileRange> ranges = {
        file.write("/description", std::span<const char>(description)),
        write("/scene/vertices", flattened(scene.vertices), 3),
        write("/scene/patches", patch_numbers(scene), numbers_per_patch),
        write("/scene/contacts", flattened(contact_ends(scene)), 3),
        write("/elements/subdivided", std::vector<std::uint32_t>(subdivided.begin(), subdivided.end()), 1),
        write("/solution/irradiance", flattened(solution.irradiance), 3)};
    if (!solution.unreduced_irradiance.empty())
        ranges.push_back(write(unreduced_dataset, flattened(solution.unreduced_irradiance), 3));
    for (const ElementNumbers& n : element_numbers)
        if (!n.needs_view || !solution.view_importance.empty())
            ranges.push_back(write(n.dataset, solution.*n.values, 1));
    ranges.push_back(write(history_dataset, history_numbers(solution), report_columns().size()));
    for (FileRange& range : write_textures(file, scene)) ranges.push_back(std::move(range));
    for (std::size_t g = 0; g < solution.groups.size(); ++g)
        ranges.push_back(write(group_dataset(g).c_str(), flattened(solution.groups[g]), 3));
    for (std::size_t part = 0; part < solution.direct.size(); ++part)
        ranges.push_back(write(direct_dataset(part).c_str(), flattened(solution.direct[part]), 3));
    return ranges;
}

constexpr const char *state_group = "/state", *state_index = "/state/index", *state_bytes = "/state/bytes";
/// Version of the state. Increase it whenever an array of the state changes.
constexpr int state_version = 6;

std::vector<FileRange> write_state(Hdf5Writer& file, const StateArchive& state) {
    Json arrays = Json::array();
    std::vector<std::span<const std::byte>> parts;
    for (const auto& [name, bytes] : state.written()) {
        arrays.push_back({name, bytes.size()});
        parts.push_back(bytes);
    }
    const std::string index =
        json_text({{"state_version", state_version}, {"version", INTERFLECT_VERSION}, {"arrays", arrays}});
    const FileRange joined = file.write_joined(state_bytes, parts);
    return {file.write(state_index, std::span<const char>(index)), joined};
}

StateArchive read_state(const VerifiedFile& file) {
    if (!file.has_checksums || !file.arrays.has(state_group))
        throw std::runtime_error("it has only the result of a run, not its state, which checkpoints have");
    const std::vector<char> text = file.arrays.read<char>(state_index);
    const Json index = parse_json_text({text.data(), text.size()});
    const auto saved_version = index.at("state_version").get<int>();
    const auto saved_by = index.at("version").get<std::string>();
    if (saved_version != state_version || saved_by != INTERFLECT_VERSION)
        throw std::runtime_error(fmt::format(
            "Interflect {} saved it with version {} of the state, but Interflect {} reads version {}; resume it with "
            "the program that saved it, or solve the scene again",
            saved_by, saved_version, INTERFLECT_VERSION, state_version));
    const std::vector<std::byte> bytes = file.arrays.read<std::byte>(state_bytes);
    std::map<std::string, std::vector<std::byte>> arrays;
    std::span<const std::byte> left = bytes;
    for (const Json& array : index.at("arrays")) {
        const auto size = array.at(1).get<std::size_t>();
        if (size > left.size()) throw std::runtime_error("the state of the run is cut short");
        const auto part = left.first(size);
        arrays[array.at(0).get<std::string>()].assign(part.begin(), part.end());
        left = left.subspan(size);
    }
    return StateArchive(std::move(arrays));
}

/// @throws std::runtime_error for an invalid scene or solution.
std::string solution_description(const Scene& scene, const Solution& solution) {
    try {
        require_valid(scene);
        require_valid(solution);
        return describe(scene, solution, format_version);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw std::runtime_error(fmt::format("the solution is not written: {}", e.what()));
    }
}

std::vector<FileRange> write_hdf5(Hdf5Writer& file, const std::string& description, const Scene& scene,
                                  const Solution& solution, const StateArchive* state) {
    std::vector<FileRange> ranges = write_arrays(file, description, scene, solution);
    if (state)
        for (FileRange& range : write_state(file, *state)) ranges.push_back(std::move(range));
    file.flush();
    return ranges;
}

void require_solution_file(const std::filesystem::path& path) {
    require_regular_file(path);
    if (!is_solution_file(path)) throw InputError(path, 0, "not a solution file");
}

template <class Read>
auto read_or_refuse(const std::filesystem::path& path, const char* fault, const Read& read) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const Json::exception& e) {
        const std::string_view text = e.what();  // it begins with a code, such as "[json.exception.type_error.302] "
        throw InputError(path, 0, fmt::format("{}: its description: {}", fault, text.substr(text.find(']') + 2)));
    } catch (const std::exception& e) {
        throw InputError(path, 0, fmt::format("{}: {}", fault, e.what()));
    }
}

/// Searches missing files of the scene beside the solution, because their paths are relative to the working folder of
/// the solve.
void find_scene_files(Scene& scene, const std::filesystem::path& folder) {
    const auto is_there = [](const std::filesystem::path& path) {
        std::error_code ignored;
        return std::filesystem::is_regular_file(path, ignored);
    };
    for (std::string& file : scene.files) {
        if (is_there(file)) continue;
        const std::filesystem::path path = file;
        for (const std::filesystem::path& candidate : {folder / path, folder / path.filename()})
            if (is_there(candidate)) {
                file = candidate.string();
                break;
            }
    }
}

constexpr const char* unreadable = "not a solution file that can be read";

}  // namespace

void write_solution(const std::filesystem::path& path, const Scene& scene, const Solution& solution) {
    detail::write_solution(path, scene, solution, nullptr);
}

void detail::write_solution(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                            const StateArchive* state) {
    const std::string description = solution_description(scene, solution);
    std::vector<FileRange> ranges;
    {
        Hdf5Writer file(path, checksum_block_size);
        ranges = write_hdf5(file, description, scene, solution, state);
    }
    write_checksums(path, std::move(ranges));
}

std::string detail::solution_image(const Scene& scene, const Solution& solution, const StateArchive* state) {
    const std::string description = solution_description(scene, solution);
    Hdf5Writer file;
    write_hdf5(file, description, scene, solution, state);
    return file.image();
}

SolvedScene read_solution(const std::filesystem::path& path) {
    require_solution_file(path);
    return read_or_refuse(path, unreadable, [&] {
        SolvedScene solved = read_solved_scene(verified(path));
        find_scene_files(solved.scene, path.parent_path());
        apply_dimming(solved);
        return solved;
    });
}

SavedRun detail::read_saved_run(const std::filesystem::path& path) {
    require_solution_file(path);
    const VerifiedFile file = read_or_refuse(path, unreadable, [&] { return verified(path); });
    SolvedScene solved = read_or_refuse(path, unreadable, [&] { return read_solved_scene(file); });
    find_scene_files(solved.scene, path.parent_path());
    return {std::move(solved), read_or_refuse(path, "a run that cannot go on", [&] { return read_state(file); })};
}

std::string detail::scene_of_saved_run(const std::filesystem::path& path) {
    try {
        require_solution_file(path);
        const Hdf5Reader file(path);
        if (!file.has(state_group)) return {};
        const std::vector<char> text = file.read<char>("/description");
        return parse_json_text({text.data(), text.size()}).at("scene").get<std::string>();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) {
        return {};
    }
}

SavedRun detail::read_saved_image(std::span<const char> image) {
    const VerifiedFile file{.has_checksums = true, .arrays = Hdf5Reader(image)};
    SolvedScene solved = read_solved_scene(file);
    return {std::move(solved), read_state(file)};
}

SolvedScene detail::read_solution_image(std::span<const char> image) {
    SolvedScene solved = read_solved_scene({.has_checksums = true, .arrays = Hdf5Reader(image)});
    apply_dimming(solved);
    return solved;
}

bool is_solution_file(const std::filesystem::path& path) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown)) return false;  // opening a pipe would wait for a writer
    return has_checksums(path) || has_hdf5_signature(path, 0) || has_hdf5_signature(path, checksum_block_size);
}

}  // namespace interflect
