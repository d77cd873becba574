#!/bin/bash
# speed.sh BUILD [COUNT]: times whole commands, reading and writing included, on the cores there are.
set -euo pipefail
build=$1 most=${2:-3000}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# name, then options of liana bake
bake() {
  local name=$1; shift
  echo "$name"
  TIMEFORMAT='  wall %R s, CPU %U s'
  time "$build/liana" bake --species apple -o "$folder/out.bake" --cache-dir "$folder/cache" "$@" \
    2>"$folder/err" | sed -n -e 's/^seconds:/  seconds:/p' -e 's/^cache:/  cache:/p' -e 's/ ([^ ]*\.cache)//'
}

"$build/make_plant" palm "$folder/palm.glb"
bake "palm, 6,085 domains" "$folder/palm.glb"
bake "palm again, other frequencies" "$folder/palm.glb" --set level1.epsilon1=-0.7
bake "palm again, heavier leaves" "$folder/palm.glb" --set leaf.c2=1.2
for ((count = 300; count <= most; count *= 10)); do
  "$build/make_plant" branches $count "$folder/branches.glb"
  bake "$count unique branches, all cores" "$folder/branches.glb" --no-cache
  bake "$count unique branches, one core" "$folder/branches.glb" --no-cache --threads 1
done
