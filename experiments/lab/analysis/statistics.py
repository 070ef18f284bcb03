"""Statistics over several seeds. Errors are positive and vary by factors, so all are computed in logarithms."""

import math
from dataclasses import dataclass

import numpy as np

CONFIDENCE = 0.95


def student_t(degrees: int, confidence: float = CONFIDENCE) -> float:
    """Computes the quantile t of Student's distribution with P(|T| < t) = confidence; degrees of freedom > 0."""
    low, high = 0.0, math.pi / 2
    for _ in range(60):  # bisections: to the last bit
        middle = (low + high) / 2
        low, high = (middle, high) if _within(middle, degrees) < confidence else (low, middle)
    return math.sqrt(degrees) * math.tan((low + high) / 2)


def _within(angle: float, degrees: int) -> float:
    """P(|T| < sqrt(degrees) tan(angle)): Abramowitz and Stegun 26.7.3 and 26.7.4."""
    cosine = math.cos(angle)
    odd = degrees % 2 == 1
    term, total = (cosine if odd else 1.0), 0.0
    for k in range(1 if odd else 0, degrees - 1, 2):
        total += term
        term *= cosine * cosine * (k + 1) / (k + 2)
    value = math.sin(angle) * total
    return 2 / math.pi * (angle + value) if odd else value


@dataclass(frozen=True)
class Curve:
    """A method's error over its budgets, with a confidence band."""

    x: np.ndarray  # geometric means over the seeds
    y: np.ndarray
    spread: np.ndarray  # standard error of log y
    degrees: int  # degrees of freedom of spread; 0: every budget has one seed, so spread is unknown

    @property
    def band(self) -> np.ndarray:
        """Confidence factor at each x: y lies between y / band and y * band."""
        return np.exp(student_t(self.degrees) * self.spread) if self.degrees else np.full(len(self.y), np.nan)


def curve(budgets: list[tuple[np.ndarray, np.ndarray]]) -> Curve:
    """Makes a curve from the x and the y of each budget's seeds.

    The relative spread between seeds is assumed equal at all budgets and estimated from all together (pooled variance),
    so that large budgets need few seeds.
    """
    xs = np.array([np.exp(np.mean(np.log(x))) for x, _ in budgets])
    logs = [np.log(y) for _, y in budgets]
    squares = sum(float(np.sum((log - log.mean()) ** 2)) for log in logs)
    degrees = sum(len(log) - 1 for log in logs)
    deviation = math.sqrt(squares / degrees) if degrees else math.nan
    counts = np.array([len(log) for log in logs])
    return Curve(xs, np.exp([log.mean() for log in logs]), deviation / np.sqrt(counts), degrees)


@dataclass(frozen=True)
class PowerLaw:
    """y = factor x^slope; half_width is the confidence interval of the slope."""

    factor: float
    slope: float
    half_width: float

    def __call__(self, x):
        return self.factor * np.asarray(x) ** self.slope


def fit_power_law(x: np.ndarray, y: np.ndarray) -> PowerLaw:
    """Fits by least squares in logarithms; at least 3 points."""
    u, v = np.log(x), np.log(y)
    du = u - u.mean()
    slope = float(du @ v / (du @ du))
    residual = v - v.mean() - slope * du
    degrees = len(u) - 2
    error = math.sqrt(residual @ residual / degrees / (du @ du))
    return PowerLaw(math.exp(v.mean() - slope * u.mean()), slope, student_t(degrees) * error)


def crossing(x: np.ndarray, y: np.ndarray, target: float) -> tuple[float, bool]:
    """Returns the x at which y falls to `target`, and whether it is extrapolated by a fit rather than interpolated.

    x ascends. If y falls to the target more than once, the last time counts.
    """
    u, v = np.log(x), np.log(y) - math.log(target)
    falls = [k for k in range(len(u) - 1) if v[k] >= 0 > v[k + 1]]
    if falls:
        k = falls[-1]
        return math.exp(u[k] + (u[k + 1] - u[k]) * v[k] / (v[k] - v[k + 1])), False
    law = np.polyfit(u, v, 1)
    return math.exp(-law[1] / law[0]), True


@dataclass(frozen=True)
class Ratio:
    """A ratio of two errors with its confidence interval from low to high; nan if unknown."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.2f}" + ("" if math.isnan(self.low) else f" ({self.low:.2f} to {self.high:.2f})")


def ratio_at(numerator: Curve, denominator: Curve, x: float) -> Ratio:
    """Returns the ratio of two curves at the same x, interpolated in logarithms."""

    def at(c: Curve, values: np.ndarray) -> float:
        return float(np.interp(math.log(x), np.log(c.x), values))

    value = at(numerator, np.log(numerator.y)) - at(denominator, np.log(denominator.y))
    degrees = min(numerator.degrees, denominator.degrees)
    error = math.hypot(at(numerator, numerator.spread), at(denominator, denominator.spread))
    half_width = student_t(degrees) * error if degrees else math.nan
    return Ratio(math.exp(value), math.exp(value - half_width), math.exp(value + half_width))


def mean_ratio(ratios: np.ndarray) -> Ratio:
    """Returns the geometric mean of independently measured ratios, with its confidence interval."""
    logs = np.log(ratios)
    m = mean(logs)
    return Ratio(math.exp(m.value), math.exp(m.value - m.half_width), math.exp(m.value + m.half_width))


@dataclass(frozen=True)
class Mean:
    value: float
    half_width: float  # half the width of the confidence interval; nan for one value

    def __str__(self) -> str:
        return f"{self.value:.3g}" if math.isnan(self.half_width) else f"{self.value:.3g} ± {self.half_width:.1g}"


def mean(values: np.ndarray) -> Mean:
    """Returns the mean with its confidence interval, by Student's distribution."""
    count = len(values)
    if count < 2:
        return Mean(float(np.mean(values)), math.nan)
    return Mean(float(np.mean(values)), student_t(count - 1) * float(np.std(values, ddof=1)) / math.sqrt(count))
