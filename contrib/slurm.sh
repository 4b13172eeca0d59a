#!/bin/sh
# A study on Slurm: slurm.sh STUDY.toml FOLDER [SHARDS], on a folder that all nodes see. Submits an array and a merge after it.
set -eu
study=$1 folder=$2 shards=${3:-24}
lancer=${LANCER:-lancer}
mkdir -p "$folder"
[ -s "$folder/plan.jsonl" ] || "$lancer" sweep plan "$study" -o "$folder/plan.jsonl"
array=$(sbatch --parsable --job-name=lancer --array="1-$shards" --output="$folder/%A_%a.log" --wrap \
    "RAYON_NUM_THREADS=\${SLURM_CPUS_PER_TASK:-1} $lancer sweep run $folder/plan.jsonl --out $folder/parts")
# The array's number says which shard a task is, so the command has none.
sbatch --job-name=lancer-merge --dependency="afterok:$array" --output="$folder/merge.log" --wrap \
    "$lancer sweep merge $folder/parts --expect $folder/plan.jsonl -o $folder/study.csv"
