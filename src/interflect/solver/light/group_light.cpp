#include "interflect/solver/light/group_light.h"

#include "interflect/base/threads/parallel.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

void accumulate(GroupLight& sum, const GroupLight& more) {
    if (sum.empty()) {
        sum = more;
        return;
    }
    for (std::size_t g = 0; g < sum.size(); ++g)
        parallel_for_ranges(sum[g].size(), elements_per_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t e = begin; e < end; ++e) sum[g][e] += more[g][e];
        });
}

std::vector<Rgb> sum_of(const GroupLight& light, const std::vector<float>& dimming) {
    std::vector<Rgb> sum(light.front().size(), Rgb(0));
    for (std::size_t g = 0; g < light.size(); ++g)
        for (std::size_t e = 0; e < sum.size() && (dimming.empty() || dimming[g] > 0); ++e) sum[e] += light[g][e];
    return sum;
}

void scale(GroupLight& light, float factor) {
    for (std::vector<Rgb>& of_group : light)
        for (Rgb& c : of_group) c *= factor;
}

}  // namespace interflect::detail
