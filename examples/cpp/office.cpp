// Solves an office until its picture has an error of 2%, draws another view, and saves the run. See README.md.
#include <interflect/interflect.h>

int main() {
    using namespace interflect;
    const Scene scene = cut_at_contacts(load_scene("scenes/office.mgf"));
    Solver solver(scene, {.views = {{scene.views.front()}}, .seed = 1});  // ihsrr; without a view hsrr
    while (solver.advance({.rays = 1'000'000}).error > 0.02) {
    }
    solver.set_views({{scene.views.back()}});  // keeps the light, finds importance anew
    solver.advance({.time = 5});  // [s]; solver.set_dimming("desk", 0.3f) dims a light group of the scene
    const Solution& solution = solver.solution();
    // solution.irradiance[i] is the illuminance of scene.patches[i] [lx]; leaves(scene, solution) lists the finer mesh
    write_image("office.exr", render(scene, solution, solver.ray_caster(), scene.views.back()).image);
    solver.save("run.h5");  // Solver::open("run.h5") goes on
}
