#include "interflect/formats/photometry/photometric_planes.h"

#include <utility>

#include "interflect/scene/core/web_angles.h"

namespace interflect::detail {

PhotometricPlanes::PhotometricPlanes(std::vector<float> angles, std::vector<float> intensities)
    : angles_(std::move(angles)), intensities_(std::move(intensities)), height_(intensities_.size() / angles_.size()) {}

void PhotometricPlanes::append(std::size_t plane, float angle) {
    angles_.push_back(angle);
    for (std::size_t j = 0; j < height_; ++j) intensities_.push_back(intensities_[plane * height_ + j]);
}

void PhotometricPlanes::mirror_at_last() {
    const float axis = angles_.back();
    for (std::size_t i = count() - 1; i-- > 0;) append(i, 2 * axis - angles_[i]);
}

void PhotometricPlanes::mirror_at_first() {
    reverse();
    const float axis = angles_.back();
    mirror_at_last();
    for (float& angle : angles_) angle -= 2 * axis;
}

void PhotometricPlanes::close() { append(0, angles_.front() + static_cast<float>(full_turn)); }

void PhotometricPlanes::reverse() {
    std::vector<float> angles, intensities;
    for (std::size_t i = count(); i-- > 0;) {
        angles.push_back(0 - angles_[i]);
        for (std::size_t j = 0; j < height_; ++j) intensities.push_back(intensities_[i * height_ + j]);
    }
    angles_ = std::move(angles);
    intensities_ = std::move(intensities);
}

std::vector<float> PhotometricPlanes::transposed() const {
    std::vector<float> result;
    result.reserve(intensities_.size());
    for (std::size_t j = 0; j < height_; ++j)
        for (std::size_t i = 0; i < count(); ++i) result.push_back(intensities_[i * height_ + j]);
    return result;
}

}  // namespace interflect::detail
