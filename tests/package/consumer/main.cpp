// Uses the installed library from scene to picture: a scene, a ray, a solution, a file, a picture.

#include <interflect/interflect.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

void expect(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "consumer: expected %s\n", what);
    std::exit(1);
}

// A closed cube of 1 m, seen from inside, with uniform emission and reflection.
interflect::Scene glowing_cube(float exitance, float reflectance) {
    interflect::Scene scene;
    scene.materials = {{"glow", interflect::Rgb(reflectance), interflect::Rgb(exitance)}};
    scene.objects = {""};
    for (int corner = 0; corner < 8; ++corner)
        scene.vertices.emplace_back(float(corner & 1), float(corner >> 1 & 1), float(corner >> 2));
    const std::array<std::array<std::uint32_t, 4>, 6> walls{
        {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}}};
    for (const auto& wall : walls) scene.patches.push_back({.vertices = wall});
    return scene;
}

// Dims one of two groups of sources during a run, then saves the run and opens it again.
void dim_a_lamp() {
    interflect::Scene scene = glowing_cube(2, 0.5f);
    scene.luminaires = {{"lamp", 0, interflect::PointLight{{0.5f, 0.5f, 0.6f}, interflect::Rgb(1)}}};
    scene.light_groups = {{"walls", "glow"}, {"lamps", "lamp*"}};
    interflect::Solver solver(scene, {.limits = {.rays = 200'000}});
    solver.advance({.rays = 100'000});
    solver.set_dimming("lamps", 0);
    solver.save("dimmed.h5");
    solver = interflect::Solver::open("dimmed.h5");
    solver.advance({});
    for (std::size_t i = 0; i < scene.patches.size(); ++i)
        expect(std::abs(solver.solution().irradiance[i].x / 4 - 1) < 0.05f,
               "the irradiance of the furnace without the lamp within 5%");
}

}  // namespace

int main() {
    constexpr float exitance = 2, reflectance = 0.5f;  // [lm/m^2], 1
    const interflect::Scene scene = glowing_cube(exitance, reflectance);
    expect(interflect::scene_faults(scene).empty(), "a cube without faults");
    const interflect::RayCaster ray_caster(scene);

    const interflect::Ray down{{0.5f, 0.5f, 0.5f}, {0, 0, -1}};
    interflect::Hit hit;
    ray_caster.trace({&down, 1}, {&hit, 1});
    expect(hit.patch == 4 && std::abs(hit.distance - 0.5f) < 1e-6f, "a ray downwards to hit the floor, 0.5 m away");

    const interflect::Solution solution = interflect::solve(scene, ray_caster, {.limits = {.rays = 100'000}});
    const float expected = exitance / (1 - reflectance);  // of a closed box: B = M + rho B = H
    for (std::size_t i = 0; i < scene.patches.size(); ++i)
        expect(std::abs(solution.irradiance[i].x / expected - 1) < 0.05f, "the irradiance of a furnace within 5%");

    interflect::write_solution("cube.h5", scene, solution);
    expect(interflect::read_solution("cube.h5").solution.irradiance == solution.irradiance, "to read what was written");

    interflect::Solver solver(scene, {.limits = {.rays = 100'000}});
    while (!solver.advance({.rays = 10'000}).is_finished) solver.save("run.h5");
    solver = interflect::Solver::open("run.h5");
    solver.advance({});
    expect(solver.solution().irradiance == solution.irradiance,
           "a run in steps, saved and opened, to have the same bits");

    const interflect::View view{.name = "inside", .eye = {0.5f, 0.5f, 0.5f}};
    solver.set_views({{view}});
    solver.advance({.rays = 50'000});
    const auto picture =
        interflect::render(solver.scene(), solver.solution(), solver.ray_caster(), view, {.width = 4, .height = 4});
    expect(picture.escaped_rays == 0, "no ray to leave a closed cube");
    expect(interflect::compare(picture.image, picture.image).flip == 0, "a picture to look like itself");

    dim_a_lamp();
    std::puts("consumer: all is well");
}
