#pragma once

#include <functional>

#include "interflect/core.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::command {

/// Light of a scene that the whole crew computes: paths of pictures, measuring points, texels, vertices and probes.
/// Without a crew it has no effect.
class CrewLight {
  public:
    /// Keeps references. @param solution  Null: light is computed from the scene alone.
    CrewLight(const Scene& scene, const Solution* solution) : scene_(scene), solution_(solution) {}
    ~CrewLight();
    CrewLight(const CrewLight&) = delete;
    CrewLight& operator=(const CrewLight&) = delete;

    /// Sends scene and solution to the others, unless they have them.
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
