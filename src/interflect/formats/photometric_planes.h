#pragma once

#include <cstddef>
#include <vector>

namespace interflect::inline detail {

/// Half planes of a photometric web that a file lists, and their completion by symmetry.
class PhotometricPlanes {
  public:
    /// @param angles       Azimuth of each [degrees], ascending.
    /// @param intensities  Of each in turn, one for each polar angle.
    PhotometricPlanes(std::vector<float> angles, std::vector<float> intensities);

    std::size_t count() const { return angles_.size(); }
    float span() const { return angles_.back() - angles_.front(); }  ///< [degrees]
    /// Adds the mirror image of all, at the last or at the first.
    void mirror_at_last();
    void mirror_at_first();
    /// Repeats the first, one turn further.
    void close();
    /// Reverses the sense of the azimuth.
    void reverse();

    const std::vector<float>& angles() const { return angles_; }
    const std::vector<float>& intensities() const { return intensities_; }
    /// The intensities with polar angle and azimuth exchanged.
    std::vector<float> transposed() const;

  private:
    void append(std::size_t plane, float angle);

    std::vector<float> angles_, intensities_;
    std::size_t height_;  // intensities of one
};

}  // namespace interflect::inline detail
