#include "apps/interflect/drawing/denoise_option.h"

#include <array>

#include "apps/interflect/values/parse.h"

namespace interflect::command {

namespace {

using Choice = std::pair<std::string, std::optional<Denoiser>>;
const std::array<Choice, 4> choices{Choice{label(Denoiser::automatic), Denoiser::automatic},
                                    Choice{label(Denoiser::oidn), Denoiser::oidn},
                                    Choice{label(Denoiser::own), Denoiser::own}, Choice{"off", std::nullopt}};

/// Whether a word after --denoise is its value, possibly a wrong one: a file has a dot or a slash in its name.
bool is_value(const std::string& word) {
    return !word.empty() && word[0] != '-' && word.find_first_of("./:") == std::string::npos;
}

}  // namespace

CLI::Option* add_denoiser(CLI::App& app, std::optional<Denoiser>& denoiser, const std::string& help) {
    return add_choice<std::optional<Denoiser>>(app, "--denoise", denoiser, {choices.begin(), choices.end()}, help);
}

void require_denoiser(std::optional<Denoiser> denoiser) {
    if (denoiser != Denoiser::oidn) return;
    if (const std::string fault = denoiser_library().fault; !fault.empty()) throw UsageError("--denoise", fault);
}

void complete_denoise(std::vector<std::string>& arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (arguments[i] == "--no-denoise") arguments[i] = "--denoise=off";
        const bool has_value = i + 1 < arguments.size() && is_value(arguments[i + 1]);
        if (arguments[i] == "--denoise" && !has_value) arguments[i] = "--denoise=auto";
    }
}

}  // namespace interflect::command
