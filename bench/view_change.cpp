// Errors after a change of views, and of a new run with as many rays, and the share of the rays that reach the error of
// the new run after the change, with 95% intervals by the jackknife over seeds (docs/method/results.md, Kept rays):
//
//     build/release/bin/view_change SCENE FROM TO RAYS SEEDS METHOD...
//
// FROM and TO are numbers of views; RAYS are traced before the change. At least two seeds.

#include <interflect/interflect.h>

#include <array>
#include <boost/math/distributions/students_t.hpp>
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
    return render(solver.scene(), solver.solution(), solver.ray_caster(), view,
                  {.width = 320, .height = 180, .shading = Shading::smooth})
        .image.pixels;
}

/// Returns the mean square of luminance errors over the squared mean.
double square_error(const std::vector<Rgb>& pixels, const std::vector<Rgb>& exact) {
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double difference = luminance(pixels[i]) - luminance(exact[i]);
        squares += difference * difference;
        sum += static_cast<double>(luminance(exact[i]));
    }
    return squares * static_cast<double>(pixels.size()) / (sum * sum);
}

Errors errors_of(Solver& solver, const View& view, const std::vector<Rgb>& exact) {
    Errors errors{};
    std::int64_t done = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        solver.advance({.rays = steps[i] - done});
        done = steps[i];
        errors[i] = square_error(picture(solver, view), exact);
    }
    return errors;
}

constexpr std::size_t none = ~std::size_t{0};

/// Returns the mean over seeds without seed `omitted`.
Errors mean(const std::vector<Errors>& by_seed, std::size_t omitted = none) {
    Errors sum{};
    for (std::size_t seed = 0; seed < by_seed.size(); ++seed)
        for (std::size_t i = 0; i < sum.size() && seed != omitted; ++i) sum[i] += by_seed[seed][i];
    for (double& e : sum) e /= static_cast<double>(by_seed.size() - (omitted == none ? 0 : 1));
    return sum;
}

/// Returns the rays, interpolated between the steps, at which `errors` fall to `target`; NaN outside of them.
double rays_to(double target, const Errors& errors) {
    for (std::size_t i = 0; i + 1 < steps.size(); ++i)
        if (errors[i] >= target && errors[i + 1] < target)
            return static_cast<double>(steps[i]) *
                   std::exp2(std::log(errors[i] / target) / std::log(errors[i] / errors[i + 1]));
    return std::nan("");
}

/// Share of the rays with its interval; NaN where it is unknown.
struct Share {
    double value, low, high;
};

/// The logarithm is taken to be normal, with the variance that leaving out one seed at a time gives.
Share share_of_rays(std::size_t step, const std::vector<Errors>& of_new_run, const std::vector<Errors>& after_change) {
    const auto log_share = [&](std::size_t omitted) {
        return std::log(rays_to(mean(of_new_run, omitted)[step], mean(after_change, omitted)) /
                        static_cast<double>(steps[step]));
    };
    const auto seeds = static_cast<double>(of_new_run.size());
    double sum = 0, squares = 0;
    for (std::size_t seed = 0; seed < of_new_run.size(); ++seed) {
        const double without = log_share(seed);
        sum += without;
        squares += without * without;
    }
    const double error = std::sqrt((squares - sum * sum / seeds) * (seeds - 1) / seeds);
    constexpr double upper_tail = 0.975;
    const double half = boost::math::quantile(boost::math::students_t(seeds - 1), upper_tail) * error;
    const double middle = log_share(none);
    return {std::exp(middle), std::exp(middle - half), std::exp(middle + half)};
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
        std::vector<Errors> of_new_run, after_change;
        for (int seed = 1; seed <= seeds; ++seed) {
            Solver new_run = setup.solver(argv[i], to, seed), continued = setup.solver(argv[i], from, seed);
            of_new_run.push_back(errors_of(new_run, to, exact));
            continued.advance({.rays = rays});
            continued.set_views({{to}});
            after_change.push_back(errors_of(continued, to, exact));
        }
        for (std::size_t k = 0; k < steps.size(); ++k) {
            const Share share = share_of_rays(k, of_new_run, after_change);
            std::printf(
                "%-7s %8lld rays: new run %.2f%%, after the change %.2f%%, share of the rays %.2f (%.2f to %.2f)\n",
                argv[i], static_cast<long long>(steps[k]), 100 * std::sqrt(mean(of_new_run)[k]),
                100 * std::sqrt(mean(after_change)[k]), share.value, share.low, share.high);
        }
        std::fflush(stdout);
    }
}
