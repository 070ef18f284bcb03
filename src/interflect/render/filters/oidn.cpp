#include "interflect/render/filters/oidn.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "interflect/base/threads/thread_count.h"

namespace interflect::detail {

namespace {

namespace fs = std::filesystem;

// Values of OpenImageDenoise/oidn.h, version 2.
constexpr int cpu_device = 1, three_floats = 3, no_error = 0, balanced_quality = 5, supported_version = 2;
constexpr const char* library_name = "libOpenImageDenoise.so.2";

std::runtime_error not_usable(const fs::path& file, const std::string& reason) {
    return std::runtime_error(
        fmt::format("{} is no library of Open Image Denoise {}: {}", file.string(), supported_version, reason));
}

}  // namespace

/// The part of the C interface that is used.
struct Oidn::Functions {
    explicit Functions(const fs::path& file) {
        // The library stays loaded, because its threads may outlive this object.
        void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (!library) throw std::runtime_error(fmt::format("cannot load {}: {}", file.string(), dlerror()));
        const auto find = [&](const char* name, auto*& function) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
            if (!function) throw not_usable(file, fmt::format("it has no function {}", name));
        };
        find("oidnNewDevice", new_device);
        find("oidnGetDeviceInt", get_device_int);
        find("oidnSetDeviceInt", set_device_int);
        find("oidnSetDeviceBool", set_device_bool);
        find("oidnCommitDevice", commit_device);
        find("oidnGetDeviceError", get_device_error);
        find("oidnReleaseDevice", release_device);
        find("oidnNewFilter", new_filter);
        find("oidnSetSharedFilterImage", set_shared_filter_image);
        find("oidnSetFilterBool", set_filter_bool);
        find("oidnSetFilterInt", set_filter_int);
        find("oidnCommitFilter", commit_filter);
        find("oidnExecuteFilter", execute_filter);
        find("oidnReleaseFilter", release_filter);
    }

    void* (*new_device)(int type);
    int (*get_device_int)(void* device, const char* name);
    void (*set_device_int)(void* device, const char* name, int value);
    void (*set_device_bool)(void* device, const char* name, bool value);
    void (*commit_device)(void* device);
    int (*get_device_error)(void* device, const char** message);
    void (*release_device)(void* device);
    void* (*new_filter)(void* device, const char* type);
    void (*set_shared_filter_image)(void* filter, const char* name, void* pixels, int format, std::size_t width,
                                    std::size_t height, std::size_t offset, std::size_t pixel_stride,
                                    std::size_t row_stride);
    void (*set_filter_bool)(void* filter, const char* name, bool value);
    void (*set_filter_int)(void* filter, const char* name, int value);
    void (*commit_filter)(void* filter);
    void (*execute_filter)(void* filter);
    void (*release_filter)(void* filter);
};

Oidn::Oidn(const fs::path& file) : file_(file), functions_(std::make_unique<Functions>(file)) {
    const Functions& call = *functions_;
    void* device = call.new_device(cpu_device);
    if (!device) throw not_usable(file, "it has no device for this processor");
    const std::array version{call.get_device_int(device, "versionMajor"), call.get_device_int(device, "versionMinor"),
                             call.get_device_int(device, "versionPatch")};
    call.release_device(device);
    version_ = fmt::format("{}.{}.{}", version[0], version[1], version[2]);
    if (version[0] != supported_version) throw not_usable(file, fmt::format("it has version {}", version_));
}

Oidn::~Oidn() = default;

namespace {

/// Adds the libraries of pyoidn in `environment`/lib/python3.*/site-packages.
void add_packages(const fs::path& environment, std::vector<fs::path>& files) {
    std::error_code missing;
    for (const fs::directory_entry& python : fs::directory_iterator(environment / "lib", missing))
        files.push_back(python.path() / "site-packages" / "pyoidn" / "oidn" / "lib" / library_name);
}

/// Returns the existing files in the order of the search.
std::vector<fs::path> installed_files() {
    std::vector<fs::path> files;
    std::error_code missing;
    const fs::path program = fs::read_symlink("/proc/self/exe", missing);
    // build/denoiser, seen from build/release/bin
    add_packages(program.parent_path().parent_path().parent_path() / "denoiser", files);
    if (const char* environment = std::getenv("VIRTUAL_ENV")) add_packages(environment, files);
    std::erase_if(files, [&](const fs::path& file) { return !fs::exists(file, missing); });
    std::sort(files.begin(), files.end());
    return files;
}

FoundOidn load(const fs::path& file) try {
    return {std::make_shared<const Oidn>(file), {}};
} catch (const std::runtime_error& e) {
    return {{}, e.what()};
}

FoundOidn search() {
    const char* chosen = std::getenv("INTERFLECT_OIDN");
    if (chosen && *chosen) {
        FoundOidn found = load(fs::absolute(chosen));
        if (!found.library) found.fault = "INTERFLECT_OIDN: " + found.fault;
        return found;
    }
    FoundOidn found = load(library_name);
    for (const fs::path& file : installed_files())
        if (!found.library) found = load(file);
    if (!found.library && installed_files().empty())
        found.fault = fmt::format(
            "{} is not installed: `scripts/setup denoiser` and `pip install pyoidn` install it, "
            "and INTERFLECT_OIDN names the file of another copy",
            library_name);
    return found;
}

}  // namespace

FoundOidn find_oidn() {
    static const FoundOidn found = search();
    return found;
}

OidnFilter::OidnFilter(std::shared_ptr<const Oidn> library, Image albedo, Image normal)
    : library_(std::move(library)), albedo_(std::move(albedo)), normal_(std::move(normal)) {
    const Oidn::Functions& call = *library_->functions_;
    device_ = {call.new_device(cpu_device), call.release_device};
    call.set_device_int(device_.get(), "numThreads", thread_count());
    call.set_device_bool(device_.get(), "setAffinity", false);  // other programs use the same cores
    call.commit_device(device_.get());
    require_success();
    filter_ = {call.new_filter(device_.get(), "RT"), call.release_filter};
    call.set_filter_bool(filter_.get(), "hdr", true);
    call.set_filter_bool(filter_.get(), "cleanAux", true);
    // The highest quality has 0.94 to 0.97 of the error of pixels in four scenes, but takes 1.05 to 1.26 times the time
    // of the whole picture. More samples lower the error as much in this time.
    call.set_filter_int(filter_.get(), "quality", balanced_quality);
}

Image OidnFilter::operator()(const Image& light) const {
    const Oidn::Functions& call = *library_->functions_;
    Image filtered(light.width, light.height);
    const auto share = [&](const char* name, const Image& image) {
        static_assert(sizeof(Rgb) == three_floats * sizeof(float));
        call.set_shared_filter_image(filter_.get(), name, const_cast<Rgb*>(image.pixels.data()), three_floats,
                                     static_cast<std::size_t>(image.width), static_cast<std::size_t>(image.height), 0,
                                     0, 0);
    };
    share("color", light);
    share("albedo", albedo_);
    share("normal", normal_);
    share("output", filtered);
    call.commit_filter(filter_.get());
    call.execute_filter(filter_.get());
    require_success();
    return filtered;
}

void OidnFilter::require_success() const {
    const char* message = nullptr;
    if (library_->functions_->get_device_error(device_.get(), &message) != no_error)
        throw std::runtime_error(fmt::format("Open Image Denoise {}: {}", library_->version(),
                                             message ? message : "an error without a message"));
}

}  // namespace interflect::detail
