"""Intel's Open Image Denoise, as its documentation recommends for pictures of path tracers: the filter of highest quality,
guided by albedo and normals that are filtered first."""

import numpy as np
import pyoidn


def denoised(picture: np.ndarray, albedo: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Filters a picture of radiance. All arguments are height x width x 3, in single precision."""
    device = pyoidn.Device()
    device.commit()
    guides = {
        "albedo": _filtered(device, {"albedo": np.clip(albedo, 0, 1)}),
        "normal": _filtered(device, {"normal": np.clip(normal, -1, 1)}),
    }
    return _filtered(device, {"color": picture, **guides}, hdr=True, cleanAux=True)


def _filtered(device: pyoidn.Device, images: dict[str, np.ndarray], **switches: bool) -> np.ndarray:
    images = {name: np.ascontiguousarray(image, np.float32) for name, image in images.items()}
    output = np.empty_like(next(iter(images.values())))
    one = pyoidn.Filter(device, pyoidn.OIDN_FILTER_TYPE_RT)
    for name, image in {**images, "output": output}.items():
        one.set_image(name, image, pyoidn.OIDN_FORMAT_FLOAT3)
    for name, value in switches.items():
        one.set_bool(name, value)
    one.set_quality(pyoidn.OIDN_QUALITY_HIGH)
    one.commit()
    one.execute()
    one.release()
    return output
