"""Draws an exported scene in Blender's Cycles: draw_in_cycles.py SCENE.py OUT.exr SAMPLES SEED BOUNCES WIDTH HEIGHT [denoise]
[guide]. Runs under a Python with the package bpy."""

import sys
from pathlib import Path

import bpy


def main(scene_file: str, output: str, numbers: list[int], switches: list[str]) -> None:
    build(Path(scene_file))
    samples, seed, bounces, width, height = numbers
    set_sampling(bpy.context.scene.cycles, samples, seed, bounces)
    set_denoiser(bpy.context.scene.cycles, "denoise" in switches)
    bpy.context.scene.cycles.use_guiding = "guide" in switches
    set_output(bpy.context.scene.render, output, width, height)
    bpy.ops.render.render(write_still=True)


def build(scene_file: Path) -> None:
    """Builds the scene. The script draws only with arguments, which it finds in sys.argv."""
    sys.argv = [str(scene_file)]
    text = scene_file.read_text()
    exec(compile(text, scene_file, "exec"), {"__file__": str(scene_file), "__name__": "__main__"})


def set_sampling(cycles, samples: int, seed: int, bounces: int) -> None:
    """Sets the same number of samples for all pixels, without clamping. Cycles counts indirect bounces only."""
    cycles.device, cycles.samples, cycles.seed = "CPU", samples, seed
    cycles.use_adaptive_sampling = False
    cycles.use_light_tree = True
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces - 1
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1


def set_denoiser(cycles, use: bool) -> None:
    """Sets Open Image Denoise to its highest quality."""
    cycles.use_denoising = use
    if use:
        cycles.denoiser, cycles.denoising_input_passes = "OPENIMAGEDENOISE", "RGB_ALBEDO_NORMAL"
        cycles.denoising_prefilter, cycles.denoising_quality = "ACCURATE", "HIGH"
        cycles.denoising_use_gpu = False


def set_output(render, output: str, width: int, height: int) -> None:
    render.engine, render.threads_mode = "CYCLES", "AUTO"
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.film_transparent = False
    settings = render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"
    render.filepath = output


scene_file, output = sys.argv[1:3]
main(scene_file, output, [int(number) for number in sys.argv[3:8]], sys.argv[8:])
