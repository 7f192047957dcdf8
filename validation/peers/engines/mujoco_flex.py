"""MuJoCo 4's rod: a 1D flex, a discrete elastic rod of point masses, under `integrator="discrete"`.

Set up as its documentation says ("Tuning", "Deformables"): Newton's solver at a tolerance of 1e-6, no contact, edges kept at their length by
equality constraints with a `solref` of their own. That one is the stiffest: with the default, the suture stretches to fifty times its length.
"""

import math

import mujoco
import numpy as np

from sampling import Diverged, answer, first_node_and_length

BAD = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)


def model_of(job):
    elements, radius = job["elements"], job["radius"]
    first, element = first_node_and_length(job)
    points = " ".join(f"{first + i * element!r} 0 0" for i in range(elements + 1))
    edges = " ".join(f"{i} {i + 1}" for i in range(elements))
    mass = job["density"] * math.pi * radius**2 * element
    # The points share the mass of a flex evenly; `corrected` gives each what belongs to it.
    total = mass * (elements + 1) if job["ends"] == "corrected" else mass * elements
    model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <size memory="64M"/>
  <option timestep="{job["step"]!r}" gravity="0 0 {-job["gravity"]!r}" integrator="discrete" solver="Newton" tolerance="1e-6"/>
  <worldbody>
    <flexcomp name="rod" type="direct" dim="1" point="{points}" element="{edges}" radius="{radius!r}" mass="{total!r}" inertiabox="{2 * radius!r}">
      <pin id="0 1"/>
      <edge equality="true" solref="{job["step"]!r} 1" solimp="0.9999 0.9999 0.0001"/>
      <contact selfcollide="none" contype="0" conaffinity="0"/>
      <elasticity young="{job["youngs_modulus"]!r}" shear="{job["shear_modulus"]!r}"/>
    </flexcomp>
  </worldbody>
</mujoco>""")
    if job["ends"] == "corrected":
        model.body_mass[model.body(f"rod_{elements}").id] *= 0.5
        mujoco.mj_setConst(model, mujoco.MjData(model))
    if job["mass_damping"]:
        # Every body slides along the axes of the world, so that damping of the joints in proportion to their inertia is damping of the momentum.
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        inertia = np.zeros(model.nv)
        mujoco.mj_mulM(model, data, inertia, np.ones(model.nv))
        model.dof_damping[:] = job["mass_damping"] * inertia
    return model


def build(job):
    model = model_of(job)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)

    def advance(steps):
        mujoco.mj_step(model, data, nstep=steps)
        # MuJoCo starts anew where its state has become bad, and goes on.
        if any(data.warning[kind].number for kind in BAD):
            raise Diverged

    return mujoco.__version__, advance, lambda: data.flexvert_xpos


if __name__ == "__main__":
    answer(build)
