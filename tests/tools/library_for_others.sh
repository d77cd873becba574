#!/usr/bin/env bash
# library_for_others.sh BUILD: installs the simulator into a scratch folder, builds runtime/examples against that alone,
# runs them, and looks for what a simulator must not need.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() { echo "library_for_others.sh: $*" >&2; exit 1; }

cmake --install "$build" --component library --prefix "$scratch/prefix" >/dev/null
cmake -S runtime/examples -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$scratch/build" >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail "the examples do not compile"; }

for program in step_a_bake grow_on_a_mesh; do
  ldd "$scratch/build/$program" | grep -iE 'libtet|libgl|libegl|epoxy|glfw|imgui|gmp|mpfr|cholmod|opencv' &&
    fail "$program needs them"
  nm -C "$scratch/build/$program" | grep -E 'CGAL::|tetgen|epoxy_|glfw' && fail "$program holds them"
done

"$build/liana" bake data/plants/apple_small.glb --species apple -o "$scratch/tree.bake" >/dev/null
"$scratch/build/step_a_bake" "$scratch/tree.bake" | tee "$scratch/path"
# It is pushed along +x for a second and swings back.
awk 'NR == 1 { start = $3 } { x = $3 - start; if (x > most) most = x; last = x }
     END { exit !(NR == 31 && most > 1e-3 && last < most / 2 && last > -most) }' "$scratch/path" ||
  fail "its tip does not go the way of a pushed tip"

cat >"$scratch/wall.obj" <<'TEXT'
v -2 0 -0.2
v 2 0 -0.2
v 2 3 -0.2
v -2 3 -0.2
v -2 0 0
v 2 0 0
v 2 3 0
v -2 3 0
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 4 8 7 3
f 1 5 8 4
f 2 3 7 6
TEXT
"$scratch/build/grow_on_a_mesh" "$scratch/wall.obj" data/species/ivy.toml | tee "$scratch/grown"
awk '{ exit !($1 > 300 && $3 > 30 && $5 > 200) }' "$scratch/grown" || fail "the ivy does not take hold of the wall"
