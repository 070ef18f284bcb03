#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/prepare.h"

namespace interflect::detail {

/// Collects the occurrences of a finding: counts all, keeps the first places.
class Finder {
  public:
    Finder(const Scene& scene, std::size_t places, Finding finding)
        : scene_(scene), places_(places), finding_(std::move(finding)) {}

    void add(Finding::Place place) {
        if (finding_.count++ < static_cast<std::int64_t>(places_)) finding_.places.push_back(std::move(place));
    }
    void add_at(const V3f& x, const std::string& object, const std::string& material) {
        add({object, material, "", scene_.origin + Imath::V3d(x), true});
    }
    void add_patch(PatchIndex i) {
        const Patch& patch = scene_.patches[i];
        add_at(PatchGeometry(scene_, patch).centre(), scene_.objects[patch.object],
               scene_.materials[patch.material].name);
    }
    void append_to(std::vector<Finding>& findings) {
        if (finding_.count > 0) findings.push_back(std::move(finding_));
    }

  private:
    const Scene& scene_;
    std::size_t places_;
    Finding finding_;
};

}  // namespace interflect::detail
