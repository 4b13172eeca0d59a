#!/bin/sh
# A study by GNU parallel: parallel.sh STUDY.toml FOLDER [SHARDS]. Killed and called again, it goes on.
set -eu
study=$1 folder=$2 shards=${3:-24}
lancer=${LANCER:-lancer}
mkdir -p "$folder"
[ -s "$folder/plan.jsonl" ] || "$lancer" sweep plan "$study" -o "$folder/plan.jsonl"
export RAYON_NUM_THREADS="${RAYON_NUM_THREADS:-1}"
seq "$shards" | parallel --will-cite --joblog "$folder/jobs.log" --resume --resume-failed \
    "$lancer" sweep run "$folder/plan.jsonl" --out "$folder/parts" --shard "{}/$shards"
"$lancer" sweep merge "$folder/parts" --expect "$folder/plan.jsonl" -o "$folder/study.csv"
