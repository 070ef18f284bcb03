// An HDF5 file may refer to arrays in any other file of the machine.
#include "interflect/exports/hdf5/hdf5_arrays.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "tests/support/scenes/scenes.h"

namespace interflect {

using namespace detail;
namespace {

namespace fs = std::filesystem;
using testing_support::TemporaryFolder;

constexpr hsize_t length = 6;  // of the external array

/// `add` creates the arrays.
template <class Add>
fs::path made(const TemporaryFolder& folder, const Add& add) {
    const fs::path path = folder.path() / "made.h5";
    const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, "no file");
    const Hdf5Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose, "no space");
    add(file, space);
    return path;
}

void add_array(hid_t file, hid_t space, hid_t properties) {
    const Hdf5Handle set(H5Dcreate2(file, "text", H5T_NATIVE_CHAR, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                         H5Dclose, "no array");
}

TEST(Hdf5Arrays, InOtherFilesAreRefused) {
    const TemporaryFolder folder;
    const fs::path raw = folder.write("raw", "secret"), whole = folder.path() / "whole.h5";
    Hdf5Writer(whole, 0).write<char>("text", std::string("secret"));
    ASSERT_EQ(Hdf5Reader(whole).read<char>("text").size(), length);

    const Hdf5Handle external(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "no properties");
    H5Pset_external(external, raw.c_str(), 0, length);
    const fs::path stored_outside = made(folder, [&](hid_t file, hid_t space) { add_array(file, space, external); });
    EXPECT_THROW(Hdf5Reader(stored_outside).read<char>("text"), std::runtime_error);

    const fs::path virtual_array = made(folder, [&](hid_t file, hid_t space) {
        const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "no properties");
        H5Pset_virtual(properties, space, whole.c_str(), "text", space);
        add_array(file, space, properties);
    });
    EXPECT_THROW(Hdf5Reader(virtual_array).read<char>("text"), std::runtime_error);

    const fs::path linked = made(folder, [&](hid_t file, hid_t) {
        H5Lcreate_external(whole.c_str(), "text", file, "text", H5P_DEFAULT, H5P_DEFAULT);
    });
    EXPECT_THROW(Hdf5Reader(linked).read<char>("text"), std::runtime_error);
}

}  // namespace
}  // namespace interflect
