#include "interflect/solver/importance/neighbourhoods.h"

#include <ImathBox.h>

#include <algorithm>
#include <numeric>

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

using Patches = std::span<PatchIndex>;

std::size_t half(std::size_t count) { return count / 2; }

constexpr std::size_t patches_at_once = 1 << 12;

void arrange(Patches patches, const std::vector<V3f>& centres) {
    if (patches.size() < 2) return;
    Imath::Box3f box;
    for (const PatchIndex p : patches) box.extendBy(centres[p]);
    const auto axis = static_cast<int>(box.majorAxis());
    const auto middle = patches.begin() + static_cast<std::ptrdiff_t>(half(patches.size()));
    std::nth_element(patches.begin(), middle, patches.end(), [&](PatchIndex a, PatchIndex b) {
        return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
    });
    const auto arrange_first = [&] { arrange(patches.first(half(patches.size())), centres); };
    const auto arrange_second = [&] { arrange(patches.subspan(half(patches.size())), centres); };
    if (patches.size() >= patches_at_once) return parallel_invoke(arrange_first, arrange_second);
    arrange_first();
    arrange_second();
}

}  // namespace

Neighbourhoods::Neighbourhoods(const ElementForest& forest) : patches_(forest.patch_count()) {
    std::vector<V3f> centres(forest.patch_count());
    for (PatchIndex p{0}; p < forest.patch_count(); ++p) {
        const PatchGeometry& geometry = forest.geometry(p);
        centres[p] = geometry.point(Cell().centre(geometry.is_triangle()));
    }
    std::iota(patches_.begin(), patches_.end(), PatchIndex(0));
    arrange(patches_, centres);
}

void Neighbourhoods::smooth(const ElementForest& forest, std::span<float> values, float share) const {
    struct Sum {
        double value = 0, area = 0;
    };
    std::vector<Sum> sums(2 * patches_.size());  // sums of the nodes, in depth-first order
    std::size_t next = 0;
    const auto add_up = [&](const auto& self, std::size_t first, std::size_t count) -> Sum {
        const std::size_t here = next++;
        Sum sum;
        if (count == 1) {
            const PatchIndex p = patches_[first];
            sum = {static_cast<double>(values[p]) * forest.area(p), forest.area(p)};
        } else {
            const Sum a = self(self, first, half(count)), b = self(self, first + half(count), count - half(count));
            sum = {a.value + b.value, a.area + b.area};
        }
        return sums[here] = sum;
    };
    add_up(add_up, 0, patches_.size());
    next = 0;
    const auto hand_down = [&](const auto& self, std::size_t first, std::size_t count, double parent) -> void {
        const Sum& sum = sums[next++];
        const double own = sum.value / sum.area, value = own + share * (parent - own);
        if (count == 1) {
            values[patches_[first]] = static_cast<float>(value);
            return;
        }
        self(self, first, half(count), value);
        self(self, first + half(count), count - half(count), value);
    };
    hand_down(hand_down, 0, patches_.size(), sums[0].value / sums[0].area);
}

}  // namespace interflect::detail
