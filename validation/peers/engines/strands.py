"""Strands, by its command: `strands simulate`, or `strands solve` where the job asks for where the rod rests.

CPU time is that of the whole process, with the reading of the scene and the writing of the answer: more than the others are charged.
"""

import json
import os
import subprocess
import sys
import tempfile

REPEATS = 3


def command(job, verb, *options):
    return [job["binary"], verb, job["scene"], "--json", "--elements", str(job["elements"]), *options]


def timed(arguments):
    """What the command prints, and the CPU time of its process, s. Raises `RuntimeError` with what it says when it fails."""
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(arguments, stdout=output, stderr=errors)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        if process.returncode != 0:
            said = errors.read().decode().strip()
            raise RuntimeError(said.splitlines()[0] if said else f"exit status {process.returncode}")
        return json.load(output), usage.ru_utime + usage.ru_stime


def tip_of(frame):
    x, _, z = frame["position"][-1]
    return x, z


def simulate(job):
    options = [
        "--seconds", repr(job["seconds"]),
        "--set", f'dynamics.integrator="{job["method"]}"',
        "--set", f"dynamics.time_step={job['step']!r}",
    ]
    # Timed without frames to write, then once more with them.
    timing = command(job, "simulate", "--every", repr(job["seconds"]), *options)
    cpu = min(timed(timing)[1] for _ in range(job.get("repeats", REPEATS)))
    path, _ = timed(command(job, "simulate", "--every", repr(job["sample_every"]), *options))
    samples = []
    for frame in path["frames"]:
        rod = frame["rods"]["rod"]
        vx, _, vz = rod["velocity"][-1]
        samples.append([frame["t"], *tip_of(rod), vx, vz])
    return {"cpu_seconds": cpu, "simulated_seconds": job["seconds"], "finished": True, "diverged": False, "tip": samples}


def solve(job):
    answers = [timed(command(job, "solve")) for _ in range(REPEATS)]
    x, z = tip_of(answers[0][0]["rods"]["rod"])
    return {"cpu_seconds": min(cpu for _, cpu in answers), "simulated_seconds": None, "finished": True, "diverged": False, "tip": [[0.0, x, z]]}


def main():
    job = json.load(sys.stdin)
    try:
        version = subprocess.run([job["binary"], "--version"], capture_output=True, text=True, check=True).stdout.split()[-1]
        print(json.dumps({"version": version, **(solve(job) if job["method"] == "statics" else simulate(job))}))
    except (OSError, RuntimeError, subprocess.CalledProcessError) as refused:
        print(json.dumps({"refused": str(refused)}))


if __name__ == "__main__":
    main()
