#!/bin/sh
# watched_by_oclgrind.sh KERNELS_DIRECTORY PROGRAM
# Runs PROGRAM under oclgrind, which checks each access of each kernel, and fails on anything that it reports: memory out of bounds, data races, wrong
# calls. Fails too if a kernel of KERNELS_DIRECTORY was not run. (Its check for values that were never written is left out: version 21.10 holds the
# counters of the grid for such, though a kernel clears them before they are counted up.)
set -eu
kernels_directory=$1
program=$2

if ! command -v oclgrind > /dev/null; then
  echo "oclgrind is not installed: apt-get install oclgrind" >&2
  exit 1
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# It takes no functions that are not inlined ("Undefined external function: llvm.experimental.noalias.scope.decl").
cp -r "$kernels_directory" "$scratch/kernels"
sed -i 's/^#define SELDOM static .*noinline.*/#define SELDOM INLINE/' "$scratch/kernels/tile.cl"
if grep -rq '__attribute__((noinline))' "$scratch/kernels"; then
  echo "a kernel has a function that is not inlined and not SELDOM, which oclgrind does not take" >&2
  exit 1
fi

# It takes llvm.vector.reduce.or without a word, and gives another value.
sed -i 's/__has_builtin(__builtin_reduce_or)/0/' "$scratch/kernels/tile.cl"
if grep -r '__builtin_reduce' "$scratch/kernels" | grep -qv 'define ANY_LANE'; then
  echo "a kernel reduces a vector by a builtin, which oclgrind does wrong: see ANY_LANE in tile.cl" >&2
  exit 1
fi

status=0
WAVETANK_KERNEL_DIRECTORY="$scratch/kernels" WAVETANK_CACHE_DIRECTORY='' oclgrind --check-api --data-races --log "$scratch/log" "$program" > "$scratch/output" 2> "$scratch/errors" || status=$?
cat "$scratch/output"
for file in errors log; do
  if [ -s "$scratch/$file" ]; then
    head -c 20000 "$scratch/$file"
    status=1
  fi
done
if ! grep -qi oclgrind "$scratch/output"; then
  echo "the program did not run on oclgrind's device" >&2
  status=1
fi

# every kernel has run
for kernel in $(sed -n 's/^__kernel void \([a-z_0-9]*\)(.*/\1/p' "$kernels_directory"/*.cl); do
  if ! grep "^kernels run:" "$scratch/output" | grep -qw "$kernel"; then
    echo "the kernel $kernel was not run" >&2
    status=1
  fi
done
exit $status
