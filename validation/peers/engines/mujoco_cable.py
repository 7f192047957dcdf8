"""MuJoCo 3's cable: rigid segments on ball joints, bent and twisted by the `mujoco.elasticity.cable` plugin.

Its elasticity is explicit under every integrator: `implicitfast` is the one that MuJoCo recommends, `Euler` the one that costs least where
nothing is damped by the joints. They have neither damping nor armature.
"""

import math

import mujoco
import numpy as np

from sampling import Diverged, answer, first_node_and_length

# A cable that is perfectly straight has no normal to build its first frame from; this bend, of an element's length, gives it one.
NUDGE = 1e-6

BAD = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)


def model_of(job):
    first, element = first_node_and_length(job)
    points = [[first + i * element, 0.0, 0.0] for i in range(job["elements"] + 1)]
    points[2][2] += NUDGE * element
    vertices = " ".join(repr(value) for point in points for value in point)
    mass = job["density"] * math.pi * job["radius"] ** 2 * element
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="mujoco.elasticity.cable"/></extension>
  <size memory="64M"/>
  <option timestep="{job["step"]!r}" gravity="0 0 {-job["gravity"]!r}" integrator="{job["method"]}"/>
  <worldbody>
    <composite type="cable" prefix="rod_" initial="none" vertex="{vertices}">
      <plugin plugin="mujoco.elasticity.cable">
        <config key="twist" value="{job["shear_modulus"]!r}"/>
        <config key="bend" value="{job["youngs_modulus"]!r}"/>
        <config key="flat" value="true"/>
      </plugin>
      <joint kind="main" damping="0" armature="0"/>
      <geom type="capsule" size="{job["radius"]!r}" mass="{mass!r}" contype="0" conaffinity="0"/>
    </composite>
  </worldbody>
</mujoco>""")


def build(job):
    model = model_of(job)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    between = range(1, job["elements"] - 1)
    bodies = [model.body(f"rod_B_{name}").id for name in ("first", *between, "last")]
    tip = model.site("rod_S_last").id
    momentum = np.zeros(model.nv)

    def damped_step():
        mujoco.mj_step1(model, data)
        mujoco.mj_mulM(model, data, momentum, data.qvel)
        data.qfrc_applied = -job["mass_damping"] * momentum
        mujoco.mj_step2(model, data)

    def advance(steps):
        if job["mass_damping"]:
            for _ in range(steps):
                damped_step()
        else:
            mujoco.mj_step(model, data, nstep=steps)
        # MuJoCo starts anew where its state has become bad, and goes on.
        if any(data.warning[kind].number for kind in BAD):
            raise Diverged

    def nodes():
        return np.vstack([data.xpos[bodies], data.site_xpos[tip]])

    return mujoco.__version__, advance, nodes


if __name__ == "__main__":
    answer(build)
