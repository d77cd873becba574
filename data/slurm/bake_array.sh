#!/bin/bash
# Bakes the plants of a manifest as a Slurm array job, one part a task:
#
#   sbatch --array=1-20 data/slurm/bake_array.sh plants.toml
#
# Tasks that die are queued again and go on where they stopped; a part that is done costs nothing. Afterwards, or
# as a job that waits for the array:
#
#   liana bake --manifest plants.toml --merge
#   sbatch --dependency=afterany:JOB --wrap "liana bake --manifest plants.toml --merge"
#
# The manifest, the plants and the outputs must lie where all nodes see them. LIANA names the program when it is
# not in the PATH. A task's exit code is 3 when a plant of its part failed; the others are baked all the same.
#SBATCH --job-name=liana-bake
#SBATCH --output=liana-bake-%A_%a.log
#SBATCH --cpus-per-task=1
#SBATCH --mem=1G
#SBATCH --time=04:00:00
#SBATCH --requeue
set -euo pipefail
manifest=${1:?"usage: sbatch --array=1-N $0 plants.toml"}
exec "${LIANA:-liana}" bake --manifest "$manifest" --jobs "${SLURM_CPUS_PER_TASK:-1}" \
  --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
