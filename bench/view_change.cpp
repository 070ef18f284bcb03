// Errors after a change of views, and of a new run with as many rays (docs/results.md, Kept rays):
//
//     build/release/bin/view_change SCENE FROM TO RAYS SEEDS METHOD...
//
// FROM and TO are numbers of views; RAYS are traced before the change.

#include <interflect/interflect.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace {

using namespace interflect;

constexpr std::array<std::int64_t, 7> steps{100'000, 200'000, 400'000, 800'000, 1'600'000, 3'200'000, 6'400'000};
constexpr std::int64_t reference_rays = 80'000'000;
using Errors = std::array<double, steps.size()>;

struct Setup {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const RayCaster> ray_caster;

    Solver solver(const char* method, const View& view, int seed) const {
        SolveOptions options{.method = find_method(method)};
        options.views = {{view}};
        options.seed = static_cast<std::uint64_t>(seed);
        return Solver(scene, options, ray_caster);
    }
};

std::vector<Rgb> picture(const Solver& solver, const View& view) {
    return render(solver.scene(), solver.solution(), solver.ray_caster(), view, {.width = 320, .height = 180})
        .image.pixels;
}

/// Returns the mean square of luminance errors over the squared mean.
double square_error(const std::vector<Rgb>& pixels, const std::vector<Rgb>& exact) {
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double difference = luminance(pixels[i]) - luminance(exact[i]);
        squares += difference * difference, sum += static_cast<double>(luminance(exact[i]));
    }
    return squares * static_cast<double>(pixels.size()) / (sum * sum);
}

void add_errors(Solver& solver, const View& view, const std::vector<Rgb>& exact, Errors& errors) {
    std::int64_t done = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        solver.advance({.rays = steps[i] - done});
        done = steps[i];
        errors[i] += square_error(picture(solver, view), exact);
    }
}

/// Returns the rays, interpolated between the steps, at which `errors` fall to `target`; NaN outside of them.
double rays_to(double target, const Errors& errors) {
    for (std::size_t i = 0; i + 1 < steps.size(); ++i)
        if (errors[i] >= target && errors[i + 1] < target)
            return static_cast<double>(steps[i]) *
                   std::exp2(std::log(errors[i] / target) / std::log(errors[i] / errors[i + 1]));
    return std::nan("");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 7) return std::fputs("usage: view_change SCENE FROM TO RAYS SEEDS METHOD...\n", stderr), 64;
    Setup setup;
    setup.scene = std::make_shared<const Scene>(cut_at_contacts(load_scene(argv[1])));
    setup.ray_caster = std::make_shared<const RayCaster>(*setup.scene);
    const View from = setup.scene->views.at(std::strtoul(argv[2], nullptr, 10)),
               to = setup.scene->views.at(std::strtoul(argv[3], nullptr, 10));
    const std::int64_t rays = std::strtoll(argv[4], nullptr, 10);
    const int seeds = std::atoi(argv[5]);
    Solver reference = setup.solver("ihsrr", to, seeds + 1);
    reference.advance({.rays = reference_rays});
    const std::vector<Rgb> exact = picture(reference, to);
    for (int i = 6; i < argc; ++i) {
        Errors of_new_run{}, after_change{};
        for (int seed = 1; seed <= seeds; ++seed) {
            Solver new_run = setup.solver(argv[i], to, seed), continued = setup.solver(argv[i], from, seed);
            add_errors(new_run, to, exact, of_new_run);
            continued.advance({.rays = rays});
            continued.set_views({{to}});
            add_errors(continued, to, exact, after_change);
        }
        for (std::size_t k = 0; k < steps.size(); ++k)
            std::printf("%-7s %8lld rays: new run %.2f%%, after the change %.2f%%, share of the rays %.2f\n", argv[i],
                        static_cast<long long>(steps[k]), 100 * std::sqrt(of_new_run[k] / seeds),
                        100 * std::sqrt(after_change[k] / seeds),
                        rays_to(of_new_run[k], after_change) / static_cast<double>(steps[k]));
    }
}
