#!/bin/sh
# One shard a task of a Slurm array:   sbatch --array=1-8 slurm.sh crowd.json
# MIEN says which program; the node's share of cores is Slurm's to give.
#SBATCH --job-name=mien
set -eu
manifest=$1
exec "${MIEN:-mien}" batch "$manifest" --quiet \
  --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" \
  --threads "${SLURM_CPUS_PER_TASK:-0}" \
  --report "${manifest%.json}.$SLURM_ARRAY_TASK_ID.report.json"
