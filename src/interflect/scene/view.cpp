#include "interflect/scene/view.h"

#include <algorithm>

#include "interflect/base/error.h"
#include "interflect/scene/core.h"

namespace interflect {

const View& find_view(const Scene& scene, const std::string& name) {
    const auto view =
        std::find_if(scene.views.begin(), scene.views.end(), [&](const View& v) { return v.name == name; });
    if (view != scene.views.end()) return *view;
    std::string known;
    for (const View& v : scene.views) known += (known.empty() ? "" : ", ") + v.name;
    throw InputError(scene.name, 0,
                     "there is no view '" + name + "'; " +
                         (known.empty() ? "the file names none, give --eye and --look-at" : "it names: " + known));
}

View overview(const Scene& scene) {
    constexpr float margin = 0.06f;  // of the box, so that the eye is not inside a wall
    constexpr float wide = 60;       // [degrees]
    const Imath::Box3f box = core_bounds(scene);
    View view;
    view.name = "overview";
    view.eye = scene.origin + Imath::V3d(box.min + box.size() * V3f(margin, margin, 0.7f));
    view.look_at = scene.origin + Imath::V3d(box.center());
    view.fov = wide;
    return view;
}

}  // namespace interflect
