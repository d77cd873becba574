#!/usr/bin/env bash
# The main job, end to end: data/demo.sh PROGRAM OUTPUT_FOLDER [bakes] (called by ./run demo). With "bakes" it stops
# when the bakes that data/scenes/wall.toml needs are there.
set -euo pipefail
liana=$1 out=$2 until=${3:-end}
mkdir -p "$out"

step() { printf '\n\033[1m%s\033[0m\n' "$*"; }

step "1. Bake: what is this tree made of?"
"$liana" bake data/plants/apple_tree.glb --species apple -o "$out/apple_tree.bake" --report "$out/apple_tree.json"
"$liana" bake data/plants/ivy_sprig.glb --species ivy -o "$out/ivy.bake" >/dev/null
[ "$until" = bakes ] && exit

step "2. Verify: does it move as baked?"
"$liana" verify "$out/apple_tree.bake" --json "$out/verify.json"

step "3. Simulate: ivy climbs a wall for 60 s beside the tree, in wind"
"$liana" simulate data/scenes/wall.toml --png "$out/wall.png" --mp4 "$out/wall.mp4" --export "$out/wall.glb" \
  --report "$out/simulate.json"

cat <<TEXT

In $out/: wall.png (look at it), wall.mp4 (growth and sway), wall.glb (for Blender or a game engine),
apple_tree.bake, apple_tree.json and verify.json (the numbers).

Next:
  ./run edit                                             grab a branch of this scene with the mouse
  $liana inspect $out/apple_tree.bake
  $liana bake data/plants/apple_tree.glb --species birch -o $out/birch.bake && $liana verify $out/birch.bake
TEXT
