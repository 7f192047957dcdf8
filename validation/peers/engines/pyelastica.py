"""PyElastica: a Cosserat rod, stepped by the explicit position Verlet method.

Set up as its examples do: `CosseratRod.straight_rod`, `OneEndFixedBC`, `GravityForces`, `AnalyticalLinearDamper`.
"""

from importlib.metadata import version

import elastica as ea
import numpy as np

from sampling import answer, first_node_and_length


class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping):
    pass


def rod_under_gravity(job):
    first, element = first_node_and_length(job)
    rod = ea.CosseratRod.straight_rod(
        job["elements"],
        start=np.array([first, 0.0, 0.0]),
        direction=np.array([1.0, 0.0, 0.0]),
        normal=np.array([0.0, 0.0, 1.0]),
        base_length=job["elements"] * element,
        base_radius=job["radius"],
        density=job["density"],
        youngs_modulus=job["youngs_modulus"],
        shear_modulus=job["shear_modulus"],
    )
    simulator = Simulator()
    simulator.append(rod)
    simulator.constrain(rod).using(ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,))
    simulator.add_forcing_to(rod).using(ea.GravityForces, acc_gravity=np.array([0.0, 0.0, -job["gravity"]]))
    if job["mass_damping"]:
        simulator.dampen(rod).using(ea.AnalyticalLinearDamper, uniform_damping_constant=job["mass_damping"], time_step=job["step"])
    simulator.finalize()
    return simulator, rod


def build(job):
    stepper, step = ea.PositionVerlet(), job["step"]

    # Compile everything before the clock starts.
    warm, _ = rod_under_gravity(job)
    for _ in range(10):
        stepper.step(warm, 0.0, step)

    simulator, rod = rod_under_gravity(job)
    time = 0.0

    def advance(steps):
        nonlocal time
        for _ in range(steps):
            time = stepper.step(simulator, time, step)

    return version("pyelastica"), advance, lambda: rod.position_collection.T


if __name__ == "__main__":
    answer(build)
