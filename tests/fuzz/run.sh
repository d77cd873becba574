#!/bin/bash
# Fuzzes for SECONDS each (default 600) the named readers, or all that are built: tests/fuzz/run.sh [SECONDS [NAME ...]]
#
# Starts from corpus/NAME, the data of the repository and what earlier runs found; leaves in build/fuzz/work/NAME
# the inputs that reach new code (found/), those that fail (crash-*, leak-*, timeout-*, oom-*) and log.txt. A failure
# does not end a run. On a busy machine give TIMEOUT=300 (s; 25 otherwise). To keep what was found, by edges:
#   build/fuzz/NAME_fuzzer -merge=1 -use_counters=0 tests/fuzz/corpus/NAME build/fuzz/work/NAME/found
set -u
top=$(cd "$(dirname "$0")/../.." && pwd)
seconds=${1:-600}
shift
names=("$@")
[ ${#names[@]} -gt 0 ] || names=($(cd "$top/build/fuzz" && ls ./*_fuzzer | sed 's|^\./||; s|_fuzzer$||'))
export TMPDIR=${TMPDIR:-/dev/shm}  # readers of files write one per input

most_bytes() {
  case $1 in
    repair_ladder) echo 400 ;;
    shells) echo 2048 ;;
    bake | species | manifest | scene) echo 8192 ;;
    *) echo 4096 ;;
  esac
}

for name in "${names[@]}"; do
  work=$top/build/fuzz/work/$name
  mkdir -p "$work/found"
  seeds=("$top/tests/fuzz/corpus/$name")
  [ "$name" = species ] && seeds+=("$top/data/species")
  [ "$name" = scene ] && seeds+=("$top/data/scenes")
  options=(-rss_limit_mb=3000 -timeout="${TIMEOUT:-25}" -max_len="$(most_bytes "$name")" -artifact_prefix="$work/" -print_final_stats=1)
  dictionary=$top/tests/fuzz/dictionaries/$name.dict
  [ -f "$dictionary" ] && options+=(-dict="$dictionary")
  end=$((SECONDS + seconds))
  while [ $SECONDS -lt $end ]; do
    "$top/build/fuzz/${name}_fuzzer" "${options[@]}" -max_total_time=$((end - SECONDS)) "$work/found" "${seeds[@]}" \
      >> "$work/log.txt" 2>&1
  done
  echo "$name: $(grep -Eo '#[0-9]+.*cov: [0-9]+ ft: [0-9]+' "$work/log.txt" | tail -n 1);" \
    "$(find "$work" -maxdepth 1 -type f ! -name log.txt ! -name "slow-*" | wc -l) failing inputs"
done
