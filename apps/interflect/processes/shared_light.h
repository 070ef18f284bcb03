#pragma once

#include <functional>

#include "interflect/core.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

/// Light of a scene that all ranks compute: paths of pictures, measuring points, texels, vertices and probes.
/// Without other ranks it has no effect.
class SharedLight {
  public:
    /// Keeps references. @param solution  Null if light is computed from the scene alone.
    SharedLight(const Scene& scene, const Solution* solution) : scene_(scene), solution_(solution) {}
    ~SharedLight();
    SharedLight(const SharedLight&) = delete;
    SharedLight& operator=(const SharedLight&) = delete;

    /// Sends scene and solution to the other ranks, unless they have them.
    void start();
    /// Calls work(monitor with the other processes), after start(). An error other than Stopped ends all processes,
    /// since the others wait for this one.
    void share(Monitor monitor, const std::function<void(const Monitor&)>& work);

  private:
    const Scene& scene_;
    const Solution* solution_;
    Ranks* ranks_ = nullptr;
};

}  // namespace interflect::command
