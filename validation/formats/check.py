#!/usr/bin/env python3
"""Write a simulation in every format and read it back with the libraries that others read it with.

What each reads must be what the JSON has: positions in double precision to round-off, in single precision (glTF, USD) to 1e-6 m.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
VENV = REPOSITORY / "target" / "formats-venv"

# Two rods in motion, one of them with a step in its section and a name that is no identifier.
SCENE = """
format = 1
name = "two rods"
gravity = [0.0, 0.0, -9.81]

[materials.rubber]
youngs_modulus = 1e6
poisson_ratio = 0.5
density = 1000.0

[rods.beam]
material = "rubber"
length = 0.2
elements = 40
section = { shape = "circle", radius = 5e-3 }
orientation = [0.7071067811865476, 0.0, 0.7071067811865476, 0.0]
supports = [{ at = "start", fix = ["position", "orientation"] }]

[rods."stepped, thin"]
material = "rubber"
length = 0.3
elements = 30
section = [
    { s = 0.0, shape = "circle", radius = 4e-3 },
    { s = 0.15, shape = "circle", radius = 4e-3 },
    { s = 0.15, shape = "rectangle", width = 4e-3, height = 6e-3 },
]
position = [0.0, 0.1, 0.0]
orientation = [0.7071067811865476, 0.0, 0.7071067811865476, 0.0]
supports = [{ at = "start", fix = ["position", "orientation"] }]
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--strands", help="the command to check (target/release/strands, or the one on the path)")
    arguments = parser.parse_args()
    if Path(sys.prefix) != VENV:
        python = python_with_readers()
        sys.exit(subprocess.run([python, __file__, *sys.argv[1:]]).returncode)
    with tempfile.TemporaryDirectory() as folder:
        check(strands_binary(arguments.strands), Path(folder))


def python_with_readers():
    """The interpreter of a virtual environment of its own."""
    python = VENV / "bin" / "python"
    if not python.exists():
        venv.create(VENV, with_pip=True)
    subprocess.run([python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"], check=True)
    return python


def strands_binary(asked):
    built = REPOSITORY / "target" / "release" / "strands"
    for path in (asked, built, shutil.which("strands")):
        if path and Path(path).is_file():
            return str(Path(path).resolve())
    sys.exit(f"no `strands` at {asked or built}: build it with `cargo build --release -p strands-cli`, or name it with --strands")


def check(strands, folder):
    import readers

    scene = folder / "two.toml"
    scene.write_text(SCENE)
    files = {ending: folder / f"motion.{ending}" for ending in ("json", "csv", "npz", "pvd", "usda", "glb")}
    outputs = [word for file in files.values() for word in ("-o", str(file))]
    start = ["--set", 'dynamics.start="rest"', "--seconds", "0.25"]
    subprocess.run([strands, "simulate", scene, *start, *outputs], check=True, stdout=subprocess.DEVNULL)
    expected = readers.expected(files["json"])
    for ending, file in files.items():
        if ending != "json":
            print(f"{ending:5} {getattr(readers, ending)(file, expected)}")


if __name__ == "__main__":
    main()
