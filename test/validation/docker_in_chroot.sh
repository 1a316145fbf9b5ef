#!/usr/bin/env bash
# docker_in_chroot.sh FOLDER [COMMAND...]
# The steps of the Dockerfile without Docker: a Debian 12 by debootstrap in FOLDER, which is made unless it is there, in which every COPY, RUN and ENV is done as it
# stands, and then what a container would start, or the command. As root; some 3 GB, and the time of a build. DEBIAN_MIRROR names another mirror.
set -euo pipefail

fail() {
  echo "docker_in_chroot: $*" >&2
  exit 1
}

[ $# -ge 1 ] && [ -n "$1" ] || fail "takes the folder of the Debian that is made, and may be given what to start in it."
[ "$(id -u)" -eq 0 ] || fail "a Debian in a folder can only be made by root."
command -v debootstrap > /dev/null || fail "debootstrap is not installed."
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
[ -e "$1/usr/bin/apt-get" ] || debootstrap --variant=minbase bookworm "$1" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}" > /dev/null
world=$(cd "$1" && pwd)
printf 'deb %s bookworm main\n' "${DEBIAN_MIRROR:-http://deb.debian.org/debian}" > "$world/etc/apt/sources.list"
cp /etc/resolv.conf "$world/etc/resolv.conf"

where=/ variables=() entry=() command=()

# What docker gives a container besides its files goes with the last process.
inside() {
  env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root "${variables[@]}" unshare --mount /bin/sh -euc '
    world=$1 where=$2; shift 2
    mount -t proc proc "$world/proc"; mount --rbind /sys "$world/sys"; mount --rbind /dev "$world/dev"
    exec chroot "$world" /bin/sh -euc "cd $where; exec \"\$@\"" sh "$@"' sh "$world" "$where" "$@"
}

list_of() { /usr/bin/python3 -c 'import json, sys; print("\n".join(json.loads(sys.argv[1])))' "$1"; }

while read -r word rest; do
  case "$word" in
    '' | '#'*) ;;
    FROM) [ "$rest" = debian:12 ] || fail "the Dockerfile is from '$rest', where debian:12 was expected." ;;
    WORKDIR) where=$rest; mkdir -p "$world$where" ;;
    ENV) variables+=("$rest") ;;
    COPY)
      from=${rest% *} to=${rest##* }
      mkdir -p "$(dirname "$world$where/$to")"
      excluded=()
      while read -r pattern; do [ -z "$pattern" ] || excluded+=(--exclude="${pattern/#\*\*\//}"); done < "$root/.dockerignore"
      if [ -d "$root/$from" ]; then
        tar -C "$root/$from" --anchored "${excluded[@]/#--exclude=/--exclude=./}" --no-anchored --exclude=__pycache__ -c . | tar -C "$world$where/$to" -x
      else
        cp "$root/$from" "$world$where/$to"
      fi
      ;;
    RUN) echo "RUN $rest"; inside /bin/sh -c "$rest" ;;
    ENTRYPOINT) mapfile -t entry < <(list_of "$rest") ;;
    CMD) mapfile -t command < <(list_of "$rest") ;;
    *) fail "the Dockerfile has '$word', which this script does not know." ;;
  esac
done < "$root/Dockerfile"

[ $# -eq 1 ] || command=("${@:2}")
echo "${entry[*]} ${command[*]}"
inside "${entry[@]}" "${command[@]}"
