"""The runs that the audit measures in each scene."""

from dataclasses import dataclass

SEEDS = (1, 2)
REFERENCE_SEEDS = (98, 99)


@dataclass(frozen=True)
class Scale:
    """Size and effort of the measurements; QUICK is for trials."""

    size: tuple[int, int] = (320, 180)
    reference_samples: int = 128  # per pixel and reference picture
    second_samples: int = 32
    mitsuba_samples: int = 64
    solving: str = ""  # options of `solve`; "": its defaults
    until_rays: str = "40M"  # limit of --until
    seconds: int = 10  # for --time
    points: int = 4000  # for bakes
    point_samples: int = 128  # paths per point and seed

    @property
    def picture_size(self) -> str:
        return f"{self.size[0]}x{self.size[1]}"


QUICK = Scale((96, 54), 64, 16, 32, "--rays 1M", "1M", 3, 600, 64)


@dataclass(frozen=True)
class Run:
    """A way to make pictures or bakes: options of `render` or `export`."""

    name: str
    options: str
    source: str = "solution"  # input: the "scene", its "solution", or its export for "mitsuba"
    stated: bool = True  # the command states errors
    shares_records: bool = False  # pixels of a block have the same error of indirect light
    mirrors: bool = True  # draws reflections in mirrors


def picture_runs(scale: Scale) -> list[Run]:
    # Without limits of rays and samples, --until would not end where too little light arrives.
    until = f"--until 5% --rays {scale.until_rays} --max-samples 128"
    hybrid = {"shares_records": True}
    return [
        Run("instant", f"--shading instant --samples {scale.second_samples}", "scene"),
        Run("path", "--shading path", "scene"),
        Run("mitsuba", f"{scale.mitsuba_samples}", "mitsuba", stated=False),
        Run("flat", "--shading flat", stated=False, mirrors=False),
        Run("smooth", "--shading smooth", stated=False, mirrors=False),
        Run("gather", "--shading gather"),
        Run("hybrid", "--shading hybrid", **hybrid),
        Run(f"hybrid --time {scale.seconds}", f"--shading hybrid --time {scale.seconds}", "scene", **hybrid),
        Run("hybrid --until 5%", f"--shading hybrid {until}", "scene", **hybrid),
    ]


BAKES = [
    Run("lightmap", "--lightmap", stated=False),
    Run("lightmap gather", "--lightmap --shading gather", stated=False),
    Run("vertices", "", stated=False),
    Run("vertices smooth", "--shading smooth", stated=False),
]
