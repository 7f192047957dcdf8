"""What every engine that runs in Python does alike: read a job, step it within a budget of CPU time, answer in JSON."""

import json
import math
import sys
import time

# A run that would cost more than its budget is stopped after this part of it, and its cost extrapolated.
PROBE = 0.2

# The most steps between two looks at the state and the clock.
BATCH = 1000


class Diverged(Exception):
    """The engine says, or its state shows, that the motion is no longer that of the rod."""


def answer(build):
    """Read a job from standard input, run `build(job)` and print what came of it.

    `build` returns `(version, advance, nodes)`: `advance(steps)` makes that many steps, `nodes()` gives the positions of the nodes, m.
    """
    job = json.load(sys.stdin)
    try:
        version, advance, nodes = build(job)
    except Exception as refused:  # whatever the engine raises is its answer
        print(json.dumps({"refused": " ".join(str(refused).split())}))
        return
    print(json.dumps({"version": version, **run(job, advance, nodes)}))


def run(job, advance, nodes):
    """Simulate `job["seconds"]`, or as much as the budget allows. CPU time is that of the steps alone."""
    step, seconds, budget = job["step"], job["seconds"], job["budget"]
    total = max(1, round(seconds / step))
    batch = max(1, min(BATCH, round(job["sample_every"] / step)))
    done, cpu, samples, diverged = 0, 0.0, [], False
    while done < total and not diverged:
        steps = min(batch, total - done)
        start = time.process_time()
        try:
            advance(steps)
        except Diverged:
            diverged = True
        cpu += time.process_time() - start
        done += steps
        state = nodes()
        diverged = diverged or lost(job, state)
        samples.append([done * step, float(state[-1][0]), float(state[-1][2])])
        if cpu > PROBE * budget and cpu / done * total > budget:
            break
    return {
        "cpu_seconds": cpu,
        "simulated_seconds": done * step,
        "finished": done == total and not diverged,
        "diverged": diverged,
        "tip": samples,
    }


def lost(job, nodes):
    """Whether the rod has become what it cannot be: not finite, a tenth longer, or higher than it was let go from."""
    length = sum(math.dist(a, b) for a, b in zip(nodes[:-1], nodes[1:]))
    kept_its_length = abs(length / job["length"] - 1.0) < 0.1
    stayed_below = nodes[-1][2] < 0.1 * job["length"]
    return not (kept_its_length and stayed_below)


def first_node_and_length(job):
    """Where the first node lies along x, and the length of an element, m.

    These engines hold the whole first element still, which clamps the rod half an element further along than asked for. `documented` leaves it
    at that; `corrected` puts the middle of the first element where the rod is clamped.
    """
    if job["ends"] == "corrected":
        element = job["length"] / (job["elements"] - 0.5)
        return -0.5 * element, element
    return 0.0, job["length"] / job["elements"]
