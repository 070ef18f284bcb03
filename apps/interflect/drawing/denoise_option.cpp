#include "apps/interflect/drawing/denoise_option.h"

#include <array>

#include "apps/interflect/values/parse.h"

namespace interflect::command {

namespace {

using DenoiserChoice = std::pair<std::string, std::optional<Denoiser>>;
const std::array<DenoiserChoice, 4> denoiser_choices{DenoiserChoice{label(Denoiser::automatic), Denoiser::automatic},
                                                     DenoiserChoice{label(Denoiser::oidn), Denoiser::oidn},
                                                     DenoiserChoice{label(Denoiser::own), Denoiser::own},
                                                     DenoiserChoice{"off", std::nullopt}};

/// Whether a word after --denoise is meant as its value, even if it is no valid one. A word with a dot, a slash or a
/// colon is a file, and one with a dash an option.
bool is_meant_as_value(const std::string& word) {
    return !word.empty() && word[0] != '-' && word.find_first_of("./:") == std::string::npos;
}

}  // namespace

CLI::Option* add_denoiser(CLI::App& app, std::optional<Denoiser>& denoiser, const std::string& help) {
    return add_choice<std::optional<Denoiser>>(app, "--denoise", denoiser,
                                               {denoiser_choices.begin(), denoiser_choices.end()}, help);
}

void require_denoiser(std::optional<Denoiser> denoiser) {
    if (denoiser != Denoiser::oidn) return;
    if (const std::string fault = denoiser_library().fault; !fault.empty()) throw UsageError("--denoise", fault);
}

void complete_denoise(std::vector<std::string>& arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (arguments[i] == "--no-denoise") arguments[i] = "--denoise=off";
        const bool has_value = i + 1 < arguments.size() && is_meant_as_value(arguments[i + 1]);
        if (arguments[i] == "--denoise" && !has_value) arguments[i] = "--denoise=auto";
    }
}

}  // namespace interflect::command
