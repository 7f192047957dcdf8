#!/bin/sh
# A column under a growing load: where it buckles, the branch that it buckles to, and everything that it could be beyond.
# Writes buckling.svg (the shapes along the branch) and buckling.json next to where it is run.
set -eu
scene=$(mktemp -d)/column.toml
trap 'rm -r "$(dirname "$scene")"' EXIT
cat > "$scene" <<'SCENE'
format = 1
name = "column"
[rods.column]
length = 0.8
elements = 80
kinematics = "kirchhoff"
stiffness = { bending = [0.05, 0.08], torsion = 0.04 }
supports = [{ at = "start", fix = ["position", "orientation"] }]
loads = [{ at = "end", force = [0.0, 0.0, 0.0] }]
SCENE
load='rods.column.loads[0].force=[0,0,0]..[0,0,-0.6]'
strands solve "$scene" --path "$load" --switch 1 -o buckling.svg -o buckling.json
strands solve "$scene" --set 'rods.column.loads[0].force=[0,0,-0.6]' --all
