#include "interflect/exports/solution_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "interflect/base/error.h"
#include "interflect/exports/checksums.h"
#include "interflect/exports/description.h"
#include "interflect/exports/json_text.h"

namespace interflect {

namespace {

/// Version 4 has checksums, options and result. Version 3 has an origin, contacts, and the surfaces of patches; before,
/// the origin was 0.
constexpr int format_version = 4, oldest_format_version = 2, first_with_checksums = 4, first_with_contacts = 3;
constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";
/// Most entries of one array that a file may claim.
constexpr hsize_t largest_array = hsize_t{1} << 32;

/// To be called before all else: errors become exceptions, not text on stderr. The handler at the process's end is left
/// out, since it crashes where a file could not be written.
void prepare_hdf5() {
    [[maybe_unused]] static const herr_t first_of_all = H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// What the system last said of a disk that takes no more; empty where it said something else.
std::string reason_of_disk() {
    const bool is_of_disk = errno == ENOSPC || errno == EDQUOT || errno == EFBIG || errno == EIO;
    return is_of_disk ? std::string(": ") + std::strerror(errno) : std::string();
}

/// An HDF5 identifier that closes itself.
class Handle {
  public:
    Handle(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close) {
        if (id < 0) throw std::runtime_error(fmt::format("HDF5: {}{}", what, reason_of_disk()));
    }
    ~Handle() { close_(id_); }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    operator hid_t() const { return id_; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

void require(herr_t status, const std::string& what) {
    if (status < 0) throw std::runtime_error("HDF5: " + what + reason_of_disk());
}

/// Memory and file type of what one array entry is made of.
template <class T>
hid_t native_type();
template <>
hid_t native_type<float>() {
    return H5T_NATIVE_FLOAT;
}
template <>
hid_t native_type<std::uint32_t>() {
    return H5T_NATIVE_UINT32;
}
template <>
hid_t native_type<char>() {
    return H5T_NATIVE_CHAR;
}
template <>
hid_t native_type<std::byte>() {
    return H5T_NATIVE_UCHAR;
}

Handle new_dataset(hid_t file, const std::string& name, hid_t type, hid_t space) {
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "cannot make properties");
    H5Pset_obj_track_times(properties, false);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "cannot make properties");
    H5Pset_create_intermediate_group(links, 1);
    return {H5Dcreate2(file, name.c_str(), type, space, links, properties, H5P_DEFAULT), H5Dclose,
            "cannot write an array"};
}

/// Writes `rows` rows of `columns` numbers; no time stamps, so that equal contents are equal bytes.
/// @return Where they are in the file.
template <class T>
FileRange write_array(hid_t file, const std::string& name, const T* data, std::size_t rows, std::size_t columns) {
    const std::array<hsize_t, 2> size{rows, columns};
    const Handle space(H5Screate_simple(columns == 1 ? 1 : 2, size.data(), nullptr), H5Sclose, "cannot size an array");
    const Handle set = new_dataset(file, name, native_type<T>(), space);
    if (rows * columns == 0) return {name, checksum_block_size, 0};
    require(H5Dwrite(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "cannot write '" + name + "'");
    return {name, H5Dget_offset(set), H5Dget_storage_size(set)};
}

template <class T>
std::vector<T> read_array(hid_t file, const std::string& name, std::size_t columns) {
    const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "an array is missing");
    const Handle space(H5Dget_space(set), H5Sclose, "an array has no size");
    // HDF5 sets memory aside for numbers as large as the file says they are.
    const Handle type(H5Dget_type(set), H5Tclose, "an array has no type");
    if (H5Tget_size(type) != sizeof(T)) throw std::runtime_error("array '" + name + "' has the wrong type");
    std::array<hsize_t, 2> size{0, 1};
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank != (columns == 1 ? 1 : 2)) throw std::runtime_error("array '" + name + "' has the wrong rank");
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
    // What a damaged file says of its arrays may be anything: no memory for more than it holds.
    hsize_t file_size = 0;
    require(H5Fget_filesize(file, &file_size), "cannot tell the file's size");
    if (size[1] != columns || size[0] > largest_array / columns ||
        size[0] * columns * sizeof(T) > std::min(H5Dget_storage_size(set), file_size))
        throw std::runtime_error("array '" + name + "' has an unexpected size");
    std::vector<T> data(size[0] * columns);
    if (!data.empty())
        require(H5Dread(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()),
                "cannot read '" + name + "'");
    return data;
}

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

/// A patch is eight numbers: four vertices, material, object, other side, surface.
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

/// @param each  Numbers of a patch: all of them, or one less.
std::vector<Patch> patches_of(const std::vector<std::uint32_t>& numbers, std::size_t each) {
    std::vector<Patch> patches(numbers.size() / each);
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const auto* n = &numbers[each * i];
        std::copy_n(n, 4, patches[i].vertices.begin());
        patches[i].material = n[4];
        patches[i].object = n[5];
        patches[i].other_side = n[6];
        if (each == numbers_per_patch) patches[i].surface = n[7];
    }
    return patches;
}

/// A contact is two points.
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
    forest->rebuild(parents);
    return forest;
}

/// What every element has one number of.
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

/// Why `numbers` cannot be what the elements have `per_element` of each; empty if they can.
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

// What a reader may rely on, and so what a writer must hold to.

void require_valid(const Scene& scene) {
    for (const std::string& fault : scene_faults(scene)) require_none(fault);
}

/// @param solution  Of a valid scene.
void require_valid(const Solution& solution) {
    const ElementForest& forest = *solution.forest;
    const auto* irradiance = reinterpret_cast<const float*>(solution.irradiance.data());
    require_none(fault_of({irradiance, 3 * solution.irradiance.size()}, 3, forest, "irradiance"));
    for (const ElementNumbers& n : element_numbers)
        if (!n.needs_view || !solution.view_importance.empty())
            require_none(fault_of(solution.*n.values, 1, forest, n.name));
    if (!is_finite(solution.emitted_power)) require_none("the emitted power is not finite");
}

/// Whether a file has the eight bytes that HDF5 begins with at `offset`.
bool has_hdf5_signature(const std::filesystem::path& path, std::uint64_t offset) {
    std::string begin(hdf5_signature.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(offset));
    return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == hdf5_signature;
}

void read_scene_arrays(hid_t file, int version, Scene& scene) {
    scene.vertices = grouped<V3f>(read_array<float>(file, "/scene/vertices", 3));
    const bool has_contacts = version >= first_with_contacts;
    const std::size_t each = has_contacts ? numbers_per_patch : numbers_per_patch - 1;
    scene.patches = patches_of(read_array<std::uint32_t>(file, "/scene/patches", each), each);
    if (has_contacts) scene.contacts = contacts_of(grouped<V3f>(read_array<float>(file, "/scene/contacts", 3)));
}

void read_solution_arrays(hid_t file, int version, bool has_importance, SolvedScene& solved) {
    Solution& solution = solved.solution;
    solution.forest = forest_of(solved.scene, read_array<std::uint32_t>(file, "/elements/subdivided", 1));
    solution.irradiance = grouped<Rgb>(read_array<float>(file, "/solution/irradiance", 3));
    for (const ElementNumbers& n : element_numbers) {
        if (n.needs_view && !has_importance) continue;
        if (version < n.since_version)
            (solution.*n.values).assign(solution.forest->size(), 0.0f);
        else
            solution.*n.values = read_array<float>(file, n.dataset, 1);
    }
    IterationReport& last = solution.iterations.back();
    last.elements = solution.forest->size();
    last.leaves = last.elements - (last.elements - solution.forest->patch_count()) / 4;
}

SolvedScene read_solution_unchecked(const std::filesystem::path& path) {
    // HDF5 would look for its beginning farther on; a file without checksums begins with it.
    const bool checked = !has_hdf5_signature(path, 0);
    if (checked) verify_checksums(path);
    prepare_hdf5();
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "not an HDF5 file");
    SolvedScene solved;
    const std::vector<char> text = read_array<char>(file, "/description", 1);
    const bool has_importance =
        read_description({text.data(), text.size()}, oldest_format_version, format_version, solved);
    if (!checked && solved.format_version >= first_with_checksums)
        throw std::runtime_error("the file is damaged: its checksums are missing");
    read_scene_arrays(file, solved.format_version, solved.scene);
    require_valid(solved.scene);
    read_solution_arrays(file, solved.format_version, has_importance, solved);
    require_valid(solved.solution);
    return solved;
}

/// @return Where the arrays are in the file.
std::vector<FileRange> write_arrays(hid_t file, const std::string& description, const Scene& scene,
                                    const Solution& solution) {
    const std::vector<std::uint32_t> parents = solution.forest->subdivided();
    std::vector<FileRange> ranges = {
        write_array(file, "/description", description.data(), description.size(), 1),
        write_array(file, "/scene/vertices", flattened(scene.vertices).data(), scene.vertices.size(), 3),
        write_array(file, "/scene/patches", patch_numbers(scene).data(), scene.patches.size(), numbers_per_patch),
        write_array(file, "/scene/contacts", flattened(contact_ends(scene)).data(), 2 * scene.contacts.size(), 3),
        write_array(file, "/elements/subdivided", parents.data(), parents.size(), 1),
        write_array(file, "/solution/irradiance", flattened(solution.irradiance).data(), solution.irradiance.size(),
                    3)};
    for (const ElementNumbers& n : element_numbers)
        if (!n.needs_view || !solution.view_importance.empty())
            ranges.push_back(write_array(file, n.dataset, (solution.*n.values).data(), (solution.*n.values).size(), 1));
    return ranges;
}

constexpr const char *state_index = "/state/index", *state_bytes = "/state/bytes";
/// Of what the arrays of a state are: to be raised whenever one of them changes.
constexpr int state_version = 1;

/// Writes the arrays of a state one after the other as one, and a list of them. @return Where they are in the file.
std::vector<FileRange> write_state(hid_t file, const StateArchive& state) {
    Json arrays = Json::array();
    hsize_t size = 0;
    for (const auto& [name, bytes] : state.written()) {
        arrays.push_back({name, bytes.size()});
        size += bytes.size();
    }
    const std::string index =
        json_text({{"state_version", state_version}, {"version", INTERFLECT_VERSION}, {"arrays", arrays}});
    const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "cannot size an array");
    const Handle set = new_dataset(file, state_bytes, native_type<std::byte>(), space);
    hsize_t begin = 0;
    for (const auto& [name, bytes] : state.written()) {
        const hsize_t count = bytes.size();
        if (count == 0) continue;
        const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose, "cannot size an array");
        H5Sselect_hyperslab(space, H5S_SELECT_SET, &begin, nullptr, &count, nullptr);
        require(H5Dwrite(set, native_type<std::byte>(), memory, space, H5P_DEFAULT, bytes.data()),
                "cannot write the state of the run");
        begin += count;
    }
    return {write_array(file, state_index, index.data(), index.size(), 1),
            {state_bytes, H5Dget_offset(set), H5Dget_storage_size(set)}};
}

StateArchive read_state_unchecked(const std::filesystem::path& path) {
    verify_checksums(path);
    prepare_hdf5();
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "not an HDF5 file");
    if (H5Lexists(file, "/state", H5P_DEFAULT) <= 0)
        throw std::runtime_error("it has only the result of a run, not its state: see solve --checkpoint");
    const std::vector<char> text = read_array<char>(file, state_index, 1);
    const Json index = parse_json_text({text.data(), text.size()});
    if (index.at("state_version") != state_version || index.at("version") != INTERFLECT_VERSION)
        throw std::runtime_error(fmt::format("its run was saved by Interflect {}; this is {}",
                                             index.at("version").get<std::string>(), INTERFLECT_VERSION));
    const std::vector<std::byte> bytes = read_array<std::byte>(file, state_bytes, 1);
    std::map<std::string, std::vector<std::byte>> arrays;
    std::span<const std::byte> left = bytes;
    for (const Json& array : index.at("arrays")) {
        const auto size = array.at(1).get<std::size_t>();
        if (size > left.size()) throw std::runtime_error("the state of the run is cut short");
        const auto some = left.first(size);
        arrays[array.at(0).get<std::string>()].assign(some.begin(), some.end());
        left = left.subspan(size);
    }
    return StateArchive(std::move(arrays));
}

/// An HDF5 file that begins with an empty block for checksums.
std::vector<FileRange> write_hdf5(const std::filesystem::path& path, const std::string& description, const Scene& scene,
                                  const Solution& solution, const StateArchive* state) {
    prepare_hdf5();
    errno = 0;
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "cannot make properties");
    require(H5Pset_userblock(creation, checksum_block_size), "cannot set a user block");
    const Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT), H5Fclose,
                      "cannot create the file");
    std::vector<FileRange> ranges = write_arrays(file, description, scene, solution);
    if (state)
        for (FileRange& range : write_state(file, *state)) ranges.push_back(std::move(range));
    require(H5Fflush(file, H5F_SCOPE_LOCAL), "cannot write the file");
    return ranges;
}

}  // namespace

void write_solution(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                    const StateArchive* state) {
    std::string description;
    try {
        require_valid(scene);
        require_valid(solution);
        description = describe(scene, solution, format_version);
    } catch (const std::exception& e) {
        throw std::runtime_error(fmt::format("the solution is not written: {}", e.what()));
    }
    write_checksums(path, write_hdf5(path, description, scene, solution, state));
}

SolvedScene read_solution(const std::filesystem::path& path) {
    if (std::filesystem::is_directory(path)) throw InputError(path, 0, "is a folder, expected a solution file");
    if (!std::filesystem::exists(path)) throw InputError(path, 0, "no such file");
    if (!is_solution_file(path)) throw InputError(path, 0, "not a solution file");
    try {
        return read_solution_unchecked(path);
    } catch (const std::exception& e) {
        throw InputError(path, 0, fmt::format("not a solution file that can be read: {}", e.what()));
    }
}

StateArchive read_state(const std::filesystem::path& path) {
    if (!is_solution_file(path)) throw InputError(path, 0, "not a solution file");
    try {
        return read_state_unchecked(path);
    } catch (const std::exception& e) {
        throw InputError(path, 0, fmt::format("a run that cannot go on: {}", e.what()));
    }
}

bool is_solution_file(const std::filesystem::path& path) {
    return has_checksums(path) || has_hdf5_signature(path, 0) || has_hdf5_signature(path, checksum_block_size);
}

}  // namespace interflect
