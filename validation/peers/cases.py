"""The rods that are compared, their right answers, and the steps that each engine is given."""

import math
from dataclasses import dataclass

GRAVITY = 9.81


@dataclass(frozen=True)
class Case:
    """A round rod of length L along x, clamped at its start, straight at rest, let go at t = 0. SI units."""

    name: str
    says: str
    length: float
    radius: float
    youngs_modulus: float
    shear_modulus: float
    density: float
    seconds: float
    sample_every: float
    elements: tuple[int, ...]
    # Momentum lost a second: twice the first natural frequency, or nothing.
    mass_damping: float = 0.0
    # Where the tip comes to rest, (x, z), and about when.
    rests_at: tuple[float, float] | None = None
    rests_after: float | None = None
    # How long the first swing takes, from the top down and up again.
    swing: float | None = None

    @property
    def stretch_speed(self):
        return math.sqrt(self.youngs_modulus / self.density)

    @property
    def shear_speed(self):
        return math.sqrt(27.0 / 28.0 * self.shear_modulus / self.density)

    @property
    def twist_speed(self):
        return math.sqrt(self.shear_modulus / self.density)

    def job(self):
        keys = ("length", "radius", "youngs_modulus", "shear_modulus", "density", "mass_damping", "seconds", "sample_every")
        return {"gravity": GRAVITY, **{key: getattr(self, key) for key in keys}}


# Where they rest: `scipy.integrate.solve_bvp` of the planar rod that bends, stretches and shears, shear factor 27/28, to 1e-9.
CASES = (
    Case(
        name="suture",
        says="nylon thread, 100 mm long, 0.4 mm thick, E = 750 MPa, ν = 0.4, 1300 kg/m³: two undamped swings",
        length=0.1,
        radius=0.2e-3,
        youngs_modulus=750e6,
        shear_modulus=750e6 / 2.8,
        density=1300.0,
        seconds=0.47,
        sample_every=1e-3,
        elements=(100, 50),
        swing=0.235,
    ),
    Case(
        name="steel",
        says="steel wire, 0.8 m long, 0.5 mm thick, E = 200 GPa, G = 77 GPa, 7850 kg/m³: damped by 2 ω₁ until it hangs still",
        length=0.8,
        radius=0.25e-3,
        youngs_modulus=200e9,
        shear_modulus=77e9,
        density=7850.0,
        seconds=4.0,
        sample_every=5e-3,
        elements=(100,),
        mass_damping=6.933,
        rests_at=(0.46660668, -0.60244098),
        rests_after=2.0,
    ),
    Case(
        name="rubber",
        says="rubber cord, 0.2 m long, 10 mm thick, E = 1 MPa, G = E/3, 1000 kg/m³: damped by 2 ω₁ until it hangs still",
        length=0.2,
        radius=5e-3,
        youngs_modulus=1e6,
        shear_modulus=1e6 / 3.0,
        density=1000.0,
        seconds=2.0,
        sample_every=5e-3,
        elements=(100, 20),
        mass_damping=13.90,
        rests_at=(0.11689341, -0.15075504),
        rests_after=1.0,
    ),
)


@dataclass(frozen=True)
class Engine:
    name: str
    module: str
    # What pip installs; None runs in the Python that runs the comparison.
    package: str | None
    methods: tuple[str, ...]
    # Steps to try, s: those of an implicit engine, or, of an explicit one, the factors of its `limit` in rising order until it diverges.
    steps: tuple[float, ...]
    quick_steps: tuple[float, ...]
    limit: object = None
    # Whether its first element is held whole, so that there are two ways to place it.
    holds_an_element: bool = True


def elastica_limit(case, elements):
    """The step at which the fastest vibration of an element, shearing and bending at once, becomes unstable: 2/ω, s."""
    element = case.length / elements
    return 1.0 / math.hypot(case.shear_speed / case.radius, case.stretch_speed / element)


def cable_limit(case, elements):
    """The step at which the fastest bending or twist of a chain of thin rigid segments becomes unstable: 2/ω, s."""
    element = case.length / elements
    bending = element**2 / (math.sqrt(3.0) * case.radius * case.stretch_speed)
    return min(bending, element / case.twist_speed)


ENGINES = (
    Engine(
        name="Strands",
        module="strands",
        package=None,
        methods=("bdf2", "sdirk4", "generalized_alpha", "midpoint"),
        steps=(20e-3, 10e-3, 5e-3, 2e-3, 1e-3, 0.5e-3, 0.25e-3),
        quick_steps=(5e-3, 1e-3),
        holds_an_element=False,
    ),
    Engine(
        name="MuJoCo 4 flex rod",
        module="mujoco_flex",
        package="mujoco==4.0.0",
        methods=("discrete",),
        steps=(20e-3, 10e-3, 5e-3, 2e-3, 1e-3, 0.5e-3, 0.25e-3, 0.1e-3),
        quick_steps=(5e-3, 1e-3),
    ),
    Engine(
        name="MuJoCo 3 cable",
        module="mujoco_cable",
        package="mujoco==3.17.0",
        methods=("implicitfast", "Euler"),
        steps=(0.25, 0.5, 0.7, 1.0, 2.0, 4.0, 8.0),
        quick_steps=(0.5,),
        limit=cable_limit,
    ),
    Engine(
        name="PyElastica",
        module="pyelastica",
        package="pyelastica==1.0.0",
        methods=("position Verlet",),
        steps=(0.5, 0.9, 1.0, 1.2, 1.5, 2.0),
        quick_steps=(0.9,),
        limit=elastica_limit,
    ),
)
