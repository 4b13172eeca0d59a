#!/usr/bin/env bash
# Sets whole processes side by side: `lancer render`, with counts, clocks and files, and a plain ray tracer in C++ and double precision.
#
#   benches/peers/tracer.sh                     the five scenes, 320 x 240 pixels
#   benches/peers/tracer.sh cornell slabs       some of them
#
# tracer.cpp beside this file is that tracer, compiled with -O3 for this host; both have one host thread. One table comes out: milliseconds of CPU time of
# the tracer, and those of `lancer render --no-error` with the profiles `ray` and `packet` as multiples of it; then how far the pictures of both are apart.
# Anything that is missing is named before something runs.
#
# RUNS (default 7) is the number of runs whose median is taken, LANCER the program to measure (default: a release build).
set -euo pipefail
cd "$(dirname "$0")/../.."
runs=${RUNS:-7}
[ "$#" -gt 0 ] || set -- cornell sphereflake slabs mirrors terrain
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

command -v g++ > "$folder/found" || { echo 'missing: g++; install it with `apt-get install g++`' >&2; exit 1; }
if [ -z "${LANCER:-}" ]; then
    cargo build --release --quiet
    LANCER=$PWD/target/release/lancer
fi
g++ -std=c++17 -O3 -march=native -Wall -Wextra -o "$folder/tracer" benches/peers/tracer.cpp

# Adds the CPU time of a command, user and system, in milliseconds, to a list.
timed() { # list, command
    local list=$1 TIMEFORMAT='%3U %3S'
    shift
    { time "$@" > "$folder/output" 2> "$folder/errors"; } 2> "$folder/time"
    awk '{ printf "%d\n", ($1 + $2) * 1000 + 0.5 }' "$folder/time" >> "$folder/$list"
}

median() { sort -g "$folder/$1" | awk '{ all[NR] = $1 } END { print all[int((NR + 1) / 2)] }'; }

printf '%-12s %10s %8s %8s   %s\n' scene 'C++, ms' ray packet 'their pictures'
for scene in "$@"; do
    "$LANCER" scene generate "$scene" -o "$folder" > "$folder/output"
    rm -f "$folder"/{tracer,ray,packet}.times
    for _ in $(seq "$runs"); do
        timed tracer.times "$folder/tracer" "$folder/$scene.dsc" "$folder/$scene.off" "$folder/tracer.pfm"
        for profile in ray packet; do
            timed "$profile.times" "$LANCER" render "$folder/$scene.dsc" --profile "$profile" --threads 1 --no-error -o "$folder/$profile.pfm"
        done
    done
    apart=$("$folder/tracer" --compare "$folder/tracer.pfm" "$folder/packet.pfm")
    awk -v scene="$scene" -v base="$(median tracer.times)" -v ray="$(median ray.times)" -v packet="$(median packet.times)" -v apart="$apart" \
        'BEGIN { printf "%-12s %10d %8.1f %8.1f   %s\n", scene, base, ray / base, packet / base, apart }'
done
