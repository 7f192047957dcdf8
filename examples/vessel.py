"""Writes the surface of a vessel with a sheath and a branch: vessel.obj, in millimetres."""

from math import cos, pi, radians, sin

AROUND = 20  # corners of a ring
SHEATH, VESSEL, BRANCH = 0.8, 2.2, 2.0  # radii
ANGLE = radians(25)  # between branch and vessel
LENGTH = 240.0  # of the branch
HOLE = [40.0, 42.4, 44.8, 47.2, 49.6]  # rings between which the branch leaves, six sides wide

corners, triangles = [], []


def ring(middle, slope, radius):
    """The numbers of the corners around a middle of a line in the plane of x and z at a slope; the first is on its upper side."""
    x, z = middle
    numbers = []
    for k in range(AROUND):
        across, up = radius * sin(2 * pi * k / AROUND), radius * cos(2 * pi * k / AROUND)
        corners.append((x - up * sin(slope), across, z + up * cos(slope)))
        numbers.append(len(corners))
    return numbers


def join(one, other, sides=range(AROUND)):
    """Puts triangles between two rings."""
    for k in sides:
        a, b, c, d = one[k], one[(k + 1) % len(one)], other[(k + 1) % len(other)], other[k]
        triangles.extend([(a, b, c), (a, c, d)])


# The sheath and the vessel: rings along x.
places = [(-160.0 + 158.0 * k / 8, SHEATH) for k in range(9)] + [(1.0, 1.4), (4.0, VESSEL)]
places += [(4.0 + 4.0 * k, VESSEL) for k in range(1, 9)] + [(x, VESSEL) for x in HOLE]
places += [(49.6 + 4.0 * k, VESSEL) for k in range(1, 16)]
rings = [ring((x, 0.0), 0.0, radius) for x, radius in places]
hole = [i for i, (x, _) in enumerate(places) if x in HOLE]
for i in range(len(rings) - 1):
    is_hole = hole[0] <= i < hole[-1]
    join(rings[i], rings[i + 1], [k for k in range(AROUND) if not (is_hole and (k < 3 or k >= AROUND - 3))])

# The rim of the hole, from its upper middle upstream around: as many corners as a ring.
up = [rings[hole[0]][k % AROUND] for k in range(0, 4)]
side = [rings[i][3] for i in hole[1:-1]]
down = [rings[hole[-1]][k % AROUND] for k in range(3, -4, -1)]
other = [rings[i][-3] for i in reversed(hole[1:-1])]
rim = up + side + down + other + [rings[hole[0]][k % AROUND] for k in range(-3, 0)]
assert len(rim) == AROUND and len(set(rim)) == AROUND

# The branch: rings along a line that winds in the plane of x and z.
x, z, step = 40.0 + 9.9 * cos(ANGLE), 9.9 * sin(ANGLE), 0.5
before, s = rim, 0.0
while s <= LENGTH:
    slope = ANGLE * cos(pi * s / 150)
    if s % 4 == 0:
        here = ring((x, z), slope, BRANCH)
        join(before, here)
        before = here
    x, z, s = x + step * cos(slope), z + step * sin(slope), s + step

with open("vessel.obj", "w") as file:
    for corner in corners:
        file.write("v %.3f %.3f %.3f\n" % corner)
    for triangle in triangles:
        file.write("f %d %d %d\n" % triangle)
