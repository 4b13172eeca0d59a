#!/usr/bin/env bash
# Runs the intersection loop on lancer and on other emulators, side by side: benches/peers/run.sh
#
# The loop is that of benches/intersection.rs: 64 rays x 4096 triangles in Q16.16, leaving a test early. For qemu-riscv64 and wasmi it is
# compiled from intersection.c beside this file. One table comes out: nanoseconds a test, how that compares with lancer's loop of
# ray-triangle instructions, and the checksum. Anything that is missing is named before something runs.
#
# RUNS (default 7) is the number of runs whose median is taken, WASMI the name of wasmi's program.
set -euo pipefail
cd "$(dirname "$0")/../.."
source=benches/peers/intersection.c
runs=${RUNS:-7}
tests=$((64 * 4096))
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
missing=0

lacks() { # what, how to get it
    echo "missing: $1; install it with \`$2\`" >&2
    missing=1
}

has() { command -v "$1" > "$folder/found"; }

has cargo || lacks cargo "apt-get install cargo"
has qemu-riscv64 || lacks qemu-riscv64 "apt-get install qemu-user"
if ! has riscv64-linux-gnu-gcc; then
    lacks riscv64-linux-gnu-gcc "apt-get install gcc-riscv64-linux-gnu libc6-dev-riscv64-cross"
elif ! riscv64-linux-gnu-gcc -O2 -march=rv64gc -static "$source" -o "$folder/riscv" 2> "$folder/errors"; then
    cat "$folder/errors" >&2
    lacks "the C library for riscv64" "apt-get install libc6-dev-riscv64-cross"
fi
if ! has clang; then
    lacks clang "apt-get install clang lld"
elif ! has wasm-ld; then
    lacks wasm-ld "apt-get install lld"
elif ! clang --target=wasm32 -O2 -nostdlib -ffreestanding -Wl,--no-entry "$source" -o "$folder/wasm.wasm" 2> "$folder/errors"; then
    cat "$folder/errors" >&2
    lacks "a clang that knows wasm32" "apt-get install clang lld"
fi
wasmi=${WASMI:-}
if [ -z "$wasmi" ]; then
    for name in wasmi wasmi_cli "$HOME/.cargo/bin/wasmi" "$HOME/.cargo/bin/wasmi_cli"; do
        if has "$name"; then wasmi=$name; break; fi
    done
fi
[ -n "$wasmi" ] || lacks wasmi "cargo install wasmi_cli"
[ "$missing" = 0 ] || exit 1

riscv() { qemu-riscv64 "$folder/riscv" "$1"; }
wasm() { "$wasmi" --invoke run "$folder/wasm.wasm" "$1" | tail -n 1; }

# Microseconds of a command, whose output goes to the file `output`.
timed() {
    local before=$EPOCHREALTIME
    "$@" > "$folder/output"
    local after=$EPOCHREALTIME
    echo $((${after/./} - ${before/./}))
}

# Nanoseconds a test: what `many` passes take longer than one, without the time to start and to make the triangles.
once() { # runner, many
    local one all
    one=$(timed "$1" 1)
    all=$(timed "$1" "$2")
    awk -v one="$one" -v all="$all" -v tests=$((tests * ($2 - 1))) 'BEGIN { printf "%.3f\n", (all - one) * 1000 / tests }'
}

median() { sort -g | awk '{ all[NR] = $1 } END { print all[int((NR + 1) / 2)] }'; }

echo "lancer: cargo bench --bench intersection" >&2
cargo bench --bench intersection > "$folder/lancer"

echo "qemu-riscv64 and wasmi in turns, $runs runs each" >&2
for _ in $(seq "$runs"); do
    once riscv 51 >> "$folder/riscv.times"
    once wasm 21 >> "$folder/wasm.times"
done

# The lines of the table: name, nanoseconds, checksum.
lancer() { # form, contender, name
    local time sum
    time=$(sed -n "s/^$1 *$2 *\([0-9.]*\) ns a test.*/\1/p" "$folder/lancer")
    sum=$(sed -n "s/^$1 *checksum //p" "$folder/lancer")
    [ -n "$time" ] && [ -n "$sum" ] || { echo "cargo bench printed nothing about $1, $2" >&2; exit 1; }
    printf '%s\t%s\t%s\n' "$3" "$time" "$sum"
}
{
    lancer rtri lancer "lancer, ray-triangle instruction"
    lancer branchy lancer "lancer, branchy"
    lancer branchy native "native code, branchy"
    printf 'qemu-riscv64, branchy\t%s\t%s\n' "$(median < "$folder/riscv.times")" "$(riscv 1)"
    printf 'wasmi, branchy\t%s\t%s\n' "$(median < "$folder/wasm.times")" "$(wasm 1)"
} > "$folder/table"

echo "$(qemu-riscv64 --version | head -n 1); $("$wasmi" --version)"
awk -F '\t' '
    NR == 1 { base = $2; printf "%-36s %12s %24s %12s\n", "loop", "ns a test", "of the instruction loop", "checksum" }
    { printf "%-36s %12.1f %24.2f %12s\n", $1, $2, $2 / base, $3 }
    /branchy/ { if (sums++ && $3 != sum) differs = 1; sum = $3 }
    END { if (differs) { print "the checksums of the branchy loops differ" > "/dev/stderr"; exit 1 } }
' "$folder/table"
