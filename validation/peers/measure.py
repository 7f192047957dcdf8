"""How far a tip is from where it should be, how much of its swing is left, and when it rests."""

import math
from bisect import bisect_right


class Path:
    """A converged path of the tip: samples `[t, x, z, vx, vz]`, cubic between them."""

    def __init__(self, samples):
        self.samples = samples
        self.times = [sample[0] for sample in samples]
        self.drop = -min(sample[2] for sample in samples)

    def at(self, t):
        i = min(max(bisect_right(self.times, t) - 1, 0), len(self.times) - 2)
        (t0, *a), (t1, *b) = self.samples[i], self.samples[i + 1]
        h = t1 - t0
        u = (t - t0) / h
        values = 1 - u**2 * (3 - 2 * u), u**2 * (3 - 2 * u)
        slopes = h * u * (1 - u) ** 2, -h * u**2 * (1 - u)
        return [values[0] * a[k] + values[1] * b[k] + slopes[0] * a[k + 2] + slopes[1] * b[k + 2] for k in (0, 1)]


def swing_error(tip, path, swing):
    """Root mean square of the distance from the converged path in the first swing, in parts of its drop; None where it was not simulated."""
    if not tip or tip[-1][0] < swing * (1.0 - 1e-6):
        return None
    squares = [math.dist(sample[1:3], path.at(sample[0])) ** 2 for sample in tip if 0.0 < sample[0] <= swing * (1.0 + 1e-6)]
    return math.sqrt(sum(squares) / len(squares)) / path.drop


def drop_kept(tip, path, swing):
    """How deep the tip goes in the second swing, in parts of how deep it should."""
    def depth(samples):
        return -min(sample[2] for sample in samples if swing < sample[0] <= 2.0 * swing)

    return depth(tip) / depth(path.samples)


def rest_error(tip, rests_at):
    """How far from its place of rest the tip is at the end, in parts of its drop."""
    return math.dist(tip[-1][1:3], rests_at) / -rests_at[1]


def rests_from(tip):
    """When the tip comes within a thousandth of its final drop of where it is at the end, for good."""
    _, x, z = tip[-1][:3]
    rest = tip[-1][0]
    for sample in reversed(tip):
        if math.dist(sample[1:3], (x, z)) > 1e-3 * abs(z):
            break
        rest = sample[0]
    return rest
