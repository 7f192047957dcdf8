#!/usr/bin/env python3
"""Run the same rods with Strands, MuJoCo 3, MuJoCo 4 and PyElastica, and print what each costs and how far off it is.

Every engine runs alone, in a virtual environment of its own under .venvs, on one thread; its time is CPU time.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import report
from cases import CASES, ENGINES
from measure import Path as TipPath
from measure import drop_kept, rest_error, rests_from, swing_error

HERE = Path(__file__).resolve().parent
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}

# A run that takes less CPU time than this, s, is made again, and the least time counts.
SHORT, REPEATS = 2.0, 3


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--case", choices=[case.name for case in CASES], help="only this rod")
    parser.add_argument("--engine", action="append", choices=[engine.module for engine in ENGINES], help="only this engine; may be repeated")
    parser.add_argument("--quick", action="store_true", help="fewer steps and a budget of 5 s a run")
    parser.add_argument("--budget", type=float, help="most CPU seconds that a run may take; one that would take more is stopped and extrapolated (60)")
    parser.add_argument("--strands", help="the command to compare (target/release/strands, or the one on the path)")
    parser.add_argument("--write", action="store_true", help="write RESULTS.md beside this script")
    arguments = parser.parse_args()
    arguments.budget = arguments.budget or (5.0 if arguments.quick else 60.0)
    binary = strands_binary(arguments.strands)

    pythons = {engine.name: python_of(engine) for engine in ENGINES if engine.module in (arguments.engine or [engine.module])}
    versions, parts = {}, []
    for case in CASES:
        if arguments.case in (None, case.name):
            parts.append(compare(case, pythons, binary, arguments, versions))

    text = "\n\n".join((f"Measured on: {report.machine()}. No run had more than {arguments.budget:g} s of CPU time.\n\n" + ", ".join(f"{name} {version}" for name, version in versions.items()) + ".", *parts))
    print(text)
    if arguments.write:
        (HERE / "RESULTS.md").write_text(f"# Strands beside its peers, measured\n\n{text}\n\n[README.md](README.md) says how to read and repeat this.\n")


def strands_binary(asked):
    built = HERE.parents[1] / "target" / "release" / "strands"
    for path in (asked, built, shutil.which("strands")):
        if path and Path(path).is_file():
            return str(Path(path).resolve())
    sys.exit(f"no `strands` at {asked or built}: build it with `cargo build --release -p strands-cli`, or name it with --strands")


def python_of(engine):
    """The Python that runs an engine, its package installed; None, with the reason on standard error, where that fails."""
    if engine.package is None:
        return sys.executable
    folder = HERE / ".venvs" / engine.module
    python = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    done = folder / "installed"
    if not (done.exists() and done.read_text() == engine.package):
        log(f"installing {engine.package}")
        venv.create(folder, clear=True, with_pip=True)
        pip = subprocess.run([python, "-m", "pip", "install", "--quiet", engine.package], capture_output=True, text=True)
        if pip.returncode != 0:
            log(f"{engine.name} is left out: `pip install {engine.package}` failed:\n{pip.stderr.strip()}")
            return None
        done.write_text(engine.package)
    return python


def compare(case, pythons, binary, arguments, versions):
    path, converged = None, ""
    if case.rests_at is None:
        path, change = reference(case, binary)
        converged = f" The reference changes by {change:.1e} when its elements and its step are doubled."
    runs = []
    for engine in ENGINES:
        if pythons.get(engine.name):
            for run in attempts(case, engine, pythons[engine.name], binary, arguments):
                if "version" in run["answer"]:
                    versions[engine.name] = run["answer"]["version"]
                runs.append({**run, **judge(case, run["answer"], path)})
                log("  ".join(cell for cell in report.row_of(runs[-1], path is not None) if cell))
    return "\n\n".join((f"## {case.name.capitalize()}", f"A {case.says}.{converged}", report.best(case, runs), report.full(case, runs)))


def reference(case, binary):
    """The converged path of the tip, and how much it changes when elements and step are doubled, in parts of its drop."""
    def path(elements, step):
        job = {"binary": binary, "scene": scene_of(case), "method": "sdirk4", "elements": elements, "step": step}
        answer = ask("strands", sys.executable, {**case.job(), **job, "repeats": 1})
        if "refused" in answer:
            sys.exit(f"the converged reference of `{case.name}` could not be made: {answer['refused']}")
        return TipPath(answer["tip"])

    log(f"{case.name}: converged reference")
    fine, coarse = path(400, 0.25e-3), path(200, 0.5e-3)
    return fine, swing_error(coarse.samples, fine, case.swing)


def attempts(case, engine, python, binary, arguments):
    """What the engine answers for every method, number of elements and step; where it holds an element, also with that one in its place."""
    steps = engine.quick_steps if arguments.quick else engine.steps
    for elements in case.elements[:1] if arguments.quick else case.elements:
        for method in engine.methods:
            def run(ends, step):
                job = {"method": method, "elements": elements, "ends": ends, "step": step, "budget": arguments.budget}
                answer = measured(engine, python, {**case.job(), **job, "binary": binary, "scene": scene_of(case)})
                return {"engine": engine.name, "method": method, "elements": elements, "ends": ends, "step": step, "answer": answer}

            finished = []
            for step in steps:
                step *= engine.limit(case, elements) if engine.limit else 1.0
                tried = run("documented" if engine.holds_an_element else "", step)
                yield tried
                if tried["answer"].get("finished"):
                    finished.append(step)
                if "refused" in tried["answer"] or (engine.limit and tried["answer"]["diverged"]):
                    break
            if engine.holds_an_element:
                yield from (run("corrected", step) for step in finished)
        if engine.module == "strands" and case.rests_at:
            job = {"method": "statics", "elements": elements, "step": None, "ends": ""}
            answer = ask(engine.module, python, {**case.job(), **job, "binary": binary, "scene": scene_of(case)})
            yield {"engine": engine.name, **job, "answer": answer}


def scene_of(case):
    return str(HERE / "scenes" / f"{case.name}.toml")


def measured(engine, python, job):
    """The engine's answer; a short run is made several times, for the least CPU time."""
    answer = ask(engine.module, python, job)
    for _ in range(REPEATS - 1):
        if engine.package and answer.get("finished") and answer["cpu_seconds"] < SHORT:
            again = ask(engine.module, python, job)
            answer["cpu_seconds"] = min(answer["cpu_seconds"], again["cpu_seconds"])
    return answer


def ask(module, python, job):
    process = subprocess.run(
        [python, HERE / "engines" / f"{module}.py"], input=json.dumps(job), capture_output=True, text=True, env={**os.environ, **ONE_THREAD}
    )
    try:
        return json.loads(process.stdout.splitlines()[-1])
    except (IndexError, json.JSONDecodeError):
        reason = process.stderr.strip().splitlines()
        return {"refused": reason[-1] if reason else f"exit status {process.returncode}"}


def judge(case, answer, path):
    """Cost, error and what else the table shows of a run."""
    if "refused" in answer:
        return {"note": f"refused: {answer['refused']}"}
    if answer["diverged"]:
        return {"note": f"diverges after {report.seconds(answer['simulated_seconds'])}"}
    tip = answer["tip"]
    if answer["simulated_seconds"] is None:
        return {"to_rest": answer["cpu_seconds"], "error": rest_error(tip, case.rests_at)}
    told = {"cost": answer["cpu_seconds"] / answer["simulated_seconds"]}
    if not answer["finished"]:
        told |= {"extrapolated": True, "note": f"stopped after {report.seconds(answer['simulated_seconds'])}"}
    if path:
        error = swing_error(tip, path, case.swing)
        told |= {"error": error} if error is not None else {}
        told |= {"kept": drop_kept(tip, path, case.swing)} if answer["finished"] else {}
    else:
        told |= {"error": rest_error(tip, case.rests_at)} if answer["finished"] else {}
        told["to_rest"] = told["cost"] * (rests_from(tip) if answer["finished"] else case.rests_after)
    return told


def log(message):
    print(message, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
