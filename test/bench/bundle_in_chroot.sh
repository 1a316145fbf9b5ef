#!/usr/bin/env bash
# bundle_in_chroot.sh BUNDLE RESULTS
# Runs a folder that scripts/bundle has made in a root with nothing else in it: without a driver it must say so; then with pocl's library, and what that needs, in the
# place of a graphics card's driver, everything must be well, within four minutes. The tables are left in the new folder RESULTS.
set -euo pipefail

readonly longest=240 # s

fail() {
  echo "bundle_in_chroot: $*" >&2
  exit 1
}

[ $# -eq 2 ] && [ -x "$1/run" ] && [ ! -e "$2" ] || fail "takes a folder made by scripts/bundle, and one to make for the results."
bundle=$1
results=$2
apart=(unshare --mount)  # what is mounted goes with the last process
[ "$(id -u)" -eq 0 ] || apart+=(--map-root-user)
"${apart[@]}" true 2> /dev/null || { echo "bundle_in_chroot: skipped, since chroot and mounts need root, or namespaces of users."; exit 0; }
driver=/usr/lib/x86_64-linux-gnu/libpocl.so.2
[ -e "$driver" ] || fail "pocl's library '$driver' is missing: apt-get install pocl-opencl-icd"

world=$(mktemp -d)
trap 'rm -rf "$world"' EXIT
mkdir "$world/bundle"
cp -a "$bundle/." "$world/bundle"
loader=(/bundle/lib/c/ld.so --library-path /bundle/lib:/bundle/lib/c)
inside() { env -i "${apart[@]}" /usr/sbin/chroot "$world" "$@"; }

echo "without anything else"
inside "${loader[@]}" /bundle/bin/wavetank_bench --list | grep -q spheric2_45 || fail "the benchmark does not start."
code=0
inside "${loader[@]}" /bundle/bin/wavetank_check 2> "$world/error" || code=$?
[ "$code" -eq 2 ] && grep -q 'no OpenCL device was found' "$world/error" || fail "without a driver the self-check ends with $code and says: $(cat "$world/error")"

# The driver: pocl, the linker that it starts, and their libraries, but for those of C++, which are the bundle's. It asks the kernel about the processor.
mkdir -p "$world/usr/lib" "$world/usr/lib64" "$world/usr/bin" "$world/usr/share" "$world/tmp" "$world/proc" "$world/sys" "$world/results"
ln -s usr/lib "$world/lib"
ln -s usr/lib64 "$world/lib64"
put() {
  mkdir -p "$world$(dirname "$1")"
  cp -L "$1" "$world$1"
}
for library in $(ldd "$driver" /usr/lib/x86_64-linux-gnu/pocl/*.so /usr/bin/ld | awk '$2 == "=>" && $3 ~ /^\// { print $3 } $1 ~ /ld-linux/ { print $1 }' | sort -u); do
  case "$library" in
    */libstdc++.so.* | */libgcc_s.so.*) ;;
    *) put "$library" ;;
  esac
done
put "$driver"
put /usr/bin/ld
for file in libc.so libc_nonshared.a libm.so libmvec.so.1 libgcc_s.so.1; do put "/usr/lib/x86_64-linux-gnu/$file"; done  # what it links kernels with
for file in $(ls -d /usr/lib/gcc/x86_64-linux-gnu/*/{crtbegin,crtbeginS,crtendS}.o /usr/lib/gcc/x86_64-linux-gnu/*/libgcc{.a,_s.so}); do put "$file"; done
cp -r /usr/lib/x86_64-linux-gnu/pocl "$world/usr/lib/x86_64-linux-gnu"
cp -r /usr/share/pocl "$world/usr/share"
put /bin/sh

echo "with pocl in the place of a driver"
begin=$(date +%s)
code=0
env -i PATH=/usr/bin OCL_ICD_VENDORS="$driver" "${apart[@]}" /bin/sh -euc 'world=$1; shift; for folder in proc sys; do mount --rbind "/$folder" "$world/$folder"; done
  exec /usr/sbin/chroot "$world" "$@"' sh "$world" "${loader[@]}" /bin/sh /bundle/run /results || code=$?
seconds=$(($(date +%s) - begin))
cp -r "$world/results" "$results"
rm -rf "$results/cache"
[ "$code" -eq 0 ] || fail "run ended with $code; its tables are in '$results'."
for file in check.txt check.json bench.txt bench.json; do
  [ -s "$results/$file" ] || fail "run has written no $file."
done
echo "self-check and benchmark: $seconds s"
[ "$seconds" -le "$longest" ] || fail "that is longer than $longest s."
