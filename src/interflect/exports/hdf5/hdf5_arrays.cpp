#include "interflect/exports/hdf5/hdf5_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <new>
#include <stdexcept>

namespace interflect::detail {

namespace {

/// Maximum number of entries of an array that is read.
constexpr hsize_t largest_array = hsize_t{1} << 32;

constexpr const char* no_properties = "cannot make properties";

/// Prepares HDF5; must precede other calls. Disables error output and the exit handler, which crashes after a failed
/// write.
void prepare_hdf5() {
    [[maybe_unused]] static const herr_t first_of_all = H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    errno = 0;
}

/// Returns the text of the last system error if a disk is full or fails, else "".
std::string reason_of_disk() {
    const bool is_of_disk = errno == ENOSPC || errno == EDQUOT || errno == EFBIG || errno == EIO;
    return is_of_disk ? std::string(": ") + std::strerror(errno) : std::string();
}

void require(herr_t status, const std::string& what) {
    if (status < 0) throw std::runtime_error("HDF5: " + what + reason_of_disk());
}

template <class T>
hid_t native_type();
template <>
hid_t native_type<float>() {
    return H5T_NATIVE_FLOAT;
}
template <>
hid_t native_type<double>() {
    return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native_type<std::uint32_t>() {
    return H5T_NATIVE_UINT32;
}
template <>
hid_t native_type<std::int64_t>() {
    return H5T_NATIVE_INT64;
}
template <>
hid_t native_type<std::uint8_t>() {
    return H5T_NATIVE_UINT8;
}
template <>
hid_t native_type<char>() {
    return H5T_NATIVE_CHAR;
}
template <>
hid_t native_type<std::byte>() {
    return H5T_NATIVE_UCHAR;
}

/// Enables compression, in chunks of about 1 MB to limit its memory.
void set_compressed_chunks(hid_t properties, std::span<const hsize_t> size) {
    constexpr hsize_t max_rows = hsize_t{1} << 16;
    constexpr unsigned deflate_level = 4;  // level 9 takes seven times as long and saves 2%
    std::vector<hsize_t> chunk(size.begin(), size.end());
    chunk[0] = std::min(chunk[0], max_rows);
    require(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()), "cannot divide an array");
    require(H5Pset_shuffle(properties), "cannot shuffle an array");
    require(H5Pset_deflate(properties, deflate_level), "cannot compress an array");
}

/// @param compressed_size  Dimensions of a compressed array; empty without compression.
Hdf5Handle new_dataset(hid_t file, const std::string& name, hid_t type, hid_t space,
                       std::span<const hsize_t> compressed_size = {}) {
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, no_properties);
    H5Pset_obj_track_times(properties, false);
    if (!compressed_size.empty()) set_compressed_chunks(properties, compressed_size);
    const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, no_properties);
    H5Pset_create_intermediate_group(links, 1);
    return {H5Dcreate2(file, name.c_str(), type, space, links, properties, H5P_DEFAULT), H5Dclose,
            "cannot write an array"};
}

hid_t opened(const std::filesystem::path& path) {
    prepare_hdf5();
    return H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
}

hid_t created(const std::filesystem::path& path, std::uint64_t user_block) {
    prepare_hdf5();
    const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, no_properties);
    require(H5Pset_userblock(creation, user_block), "cannot set a user block");
    return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
}

void keep_in_memory(hid_t access) {
    constexpr std::size_t growth = std::size_t{1} << 24;  // [bytes]
    require(H5Pset_fapl_core(access, growth, false), "cannot keep a file in memory");
}

hid_t created_in_memory() {
    prepare_hdf5();
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, no_properties);
    keep_in_memory(access);
    return H5Fcreate("memory", H5F_ACC_TRUNC, H5P_DEFAULT, access);
}

hid_t opened(std::span<const char> image) {
    prepare_hdf5();
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, no_properties);
    keep_in_memory(access);
    // HDF5 copies the bytes and does not change them.
    if (H5Pset_file_image(access, const_cast<char*>(image.data()), image.size()) < 0) throw std::bad_alloc();
    return H5Fopen("memory", H5F_ACC_RDONLY, access);
}

void write_attribute_of_type(hid_t file, const std::string& group, const char* name, hid_t type, hid_t space,
                             const void* value) {
    const Hdf5Handle owner(H5Gopen2(file, group.c_str(), H5P_DEFAULT), H5Gclose, "a group is missing");
    const Hdf5Handle attribute(H5Acreate2(owner, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                               "cannot write an attribute");
    require(H5Awrite(attribute, type, value), "cannot write an attribute");
}

herr_t refuse_other_files(const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) { return -1; }

/// Refuses external and virtual storage, which could refer to any file.
void require_stored_here(hid_t dataset, const std::string& name) {
    const Hdf5Handle properties(H5Dget_create_plist(dataset), H5Pclose, "an array has no properties");
    if (H5Pget_external_count(properties) != 0 || H5Pget_layout(properties) == H5D_VIRTUAL)
        throw std::runtime_error("array '" + name + "' is in another file, which is not allowed");
}

}  // namespace

std::recursive_mutex& Hdf5Lock::mutex() {
    static std::recursive_mutex mutex;
    return mutex;
}

Hdf5Handle::Hdf5Handle(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close) {
    if (id < 0) throw std::runtime_error(fmt::format("HDF5: {}{}", what, reason_of_disk()));
}

template <class Source>
Hdf5Reader::Hdf5Reader(Hdf5Lock lock, const Source& source)
    : lock_(std::move(lock)),
      file_(opened(source), H5Fclose, "not an HDF5 file"),
      links_(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, no_properties) {
    require(H5Pset_elink_cb(links_, refuse_other_files, nullptr), no_properties);
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) : Hdf5Reader(Hdf5Lock(), path) {}

Hdf5Reader::Hdf5Reader(std::span<const char> image) : Hdf5Reader(Hdf5Lock(), image) {}

bool Hdf5Reader::has(const std::string& name) const { return H5Lexists(file_, name.c_str(), links_) > 0; }

template <class T>
std::vector<T> Hdf5Reader::read(const std::string& name, std::size_t columns) const {
    const Hdf5Handle dataset(H5Dopen2(file_, name.c_str(), links_), H5Dclose, "an array is missing");
    require_stored_here(dataset, name);
    const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, "an array has no size");
    // Check type and size before reading, because the file could state any size to allocate.
    const Hdf5Handle type(H5Dget_type(dataset), H5Tclose, "an array has no type");
    if (H5Tget_size(type) != sizeof(T)) throw std::runtime_error("array '" + name + "' has the wrong type");
    std::array<hsize_t, 2> size{0, 1};
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank != (columns == 1 ? 1 : 2)) throw std::runtime_error("array '" + name + "' has the wrong rank");
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
    hsize_t file_size = 0;
    require(H5Fget_filesize(file_, &file_size), "cannot tell the file's size");
    if (size[1] != columns || size[0] > largest_array / columns ||
        size[0] * columns * sizeof(T) > std::min(H5Dget_storage_size(dataset), file_size))
        throw std::runtime_error("array '" + name + "' has an unexpected size");
    std::vector<T> data(size[0] * columns);
    if (!data.empty())
        require(H5Dread(dataset, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()),
                "cannot read '" + name + "'");
    return data;
}

template std::vector<float> Hdf5Reader::read(const std::string&, std::size_t) const;
template std::vector<double> Hdf5Reader::read(const std::string&, std::size_t) const;
template std::vector<std::uint32_t> Hdf5Reader::read(const std::string&, std::size_t) const;
template std::vector<char> Hdf5Reader::read(const std::string&, std::size_t) const;
template std::vector<std::byte> Hdf5Reader::read(const std::string&, std::size_t) const;

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path, std::uint64_t user_block)
    : file_(created(path, user_block), H5Fclose, "cannot create the file") {}

Hdf5Writer::Hdf5Writer() : file_(created_in_memory(), H5Fclose, "cannot create a file in memory") {}

template <class T>
FileRange Hdf5Writer::write(const std::string& name, std::span<const T> numbers, std::size_t columns) {
    const std::array<hsize_t, 2> size{numbers.size() / columns, columns};
    const Hdf5Handle space(H5Screate_simple(columns == 1 ? 1 : 2, size.data(), nullptr), H5Sclose,
                           "cannot size an array");
    const Hdf5Handle dataset = new_dataset(file_, name, native_type<T>(), space);
    if (numbers.empty()) return {name, checksum_block_size, 0};
    require(H5Dwrite(dataset, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
            "cannot write '" + name + "'");
    return {name, H5Dget_offset(dataset), H5Dget_storage_size(dataset)};
}

template FileRange Hdf5Writer::write(const std::string&, std::span<const float>, std::size_t);
template FileRange Hdf5Writer::write(const std::string&, std::span<const double>, std::size_t);
template FileRange Hdf5Writer::write(const std::string&, std::span<const std::int64_t>, std::size_t);
template FileRange Hdf5Writer::write(const std::string&, std::span<const std::uint32_t>, std::size_t);
template FileRange Hdf5Writer::write(const std::string&, std::span<const std::uint8_t>, std::size_t);
template FileRange Hdf5Writer::write(const std::string&, std::span<const char>, std::size_t);

template <class T>
void Hdf5Writer::write_compressed(const std::string& name, std::span<const T> numbers, std::size_t columns) {
    if (numbers.empty()) {
        write(name, numbers, columns);
        return;
    }
    const std::array<hsize_t, 2> size{numbers.size() / columns, columns};
    const int rank = columns == 1 ? 1 : 2;
    const Hdf5Handle space(H5Screate_simple(rank, size.data(), nullptr), H5Sclose, "cannot size an array");
    const std::span<const hsize_t> dimensions(size.data(), static_cast<std::size_t>(rank));
    const Hdf5Handle dataset = new_dataset(file_, name, native_type<T>(), space, dimensions);
    require(H5Dwrite(dataset, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
            "cannot write '" + name + "'");
}

template void Hdf5Writer::write_compressed(const std::string&, std::span<const float>, std::size_t);
template void Hdf5Writer::write_compressed(const std::string&, std::span<const double>, std::size_t);
template void Hdf5Writer::write_compressed(const std::string&, std::span<const std::int64_t>, std::size_t);
template void Hdf5Writer::write_compressed(const std::string&, std::span<const std::uint32_t>, std::size_t);
template void Hdf5Writer::write_compressed(const std::string&, std::span<const std::uint8_t>, std::size_t);

void Hdf5Writer::write_attribute(const std::string& group, const char* name, std::span<const std::int64_t> numbers) {
    const hsize_t size = numbers.size();
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "cannot size an attribute");
    write_attribute_of_type(file_, group, name, native_type<std::int64_t>(), space, numbers.data());
}

void Hdf5Writer::write_attribute(const std::string& group, const char* name, std::string_view text) {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "cannot make a type");
    require(H5Tset_size(type, text.size()), "cannot size a text");
    require(H5Tset_strpad(type, H5T_STR_NULLPAD), "cannot make a type");
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose, "cannot size an attribute");
    write_attribute_of_type(file_, group, name, type, space, text.data());
}

FileRange Hdf5Writer::write_joined(const std::string& name, const std::vector<std::span<const std::byte>>& parts) {
    hsize_t size = 0;
    for (const auto& part : parts) size += part.size();
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "cannot size an array");
    const Hdf5Handle dataset = new_dataset(file_, name, native_type<std::byte>(), space);
    hsize_t begin = 0;
    for (const auto& part : parts) {
        const hsize_t count = part.size();
        if (count == 0) continue;
        const Hdf5Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose, "cannot size an array");
        H5Sselect_hyperslab(space, H5S_SELECT_SET, &begin, nullptr, &count, nullptr);
        require(H5Dwrite(dataset, native_type<std::byte>(), memory, space, H5P_DEFAULT, part.data()),
                "cannot write '" + name + "'");
        begin += count;
    }
    return {name, H5Dget_offset(dataset), H5Dget_storage_size(dataset)};
}

void Hdf5Writer::flush() { require(H5Fflush(file_, H5F_SCOPE_LOCAL), "cannot write the file"); }

std::string Hdf5Writer::image() {
    flush();
    const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
    std::string bytes(size < 0 ? 0 : static_cast<std::size_t>(size), '\0');
    if (size < 0 || H5Fget_file_image(file_, bytes.data(), bytes.size()) < 0)
        throw std::runtime_error("HDF5: cannot get the file's bytes");
    return bytes;
}

}  // namespace interflect::detail
