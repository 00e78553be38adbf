#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# README's two commands on a machine that has nothing: makes a Debian 12 with nothing but git in a
# folder (debootstrap), clones this repository's HEAD into it and runs ./demo.sh and ./test.sh
# there, twice each. Needs root, a network, some 6 GB of disk, and debootstrap.
#
# usage: fresh_machine.sh FOLDER       FOLDER must not exist; it is left for a look
set -euo pipefail
if [ $# -ne 1 ] || [ -e "$1" ]; then
  sed -n 's/^# usage: /usage: /p' "$0" >&2
  exit 2
fi
source=$(cd "$(dirname "$0")/.." && pwd)
root=$1
mirror=${MIRROR:-http://deb.debian.org/debian}

started=$SECONDS
lap() {
  echo "== $1: $((SECONDS - started)) s, $(du -sxm "$root" 2>/dev/null | cut -f1) MB in all"
  started=$SECONDS
}

debootstrap --variant=minbase --include=git,ca-certificates bookworm "$root" "$mirror" >/dev/null
cp /etc/apt/apt.conf "$root/etc/apt/" 2>/dev/null || true # a proxy, if this machine has one
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
lap "Debian 12 with git"

mount --bind /proc "$root/proc"
mount --bind /dev "$root/dev"
mount --bind /dev/pts "$root/dev/pts" # pseudo-terminals: one test looks at a progress line
trap 'umount "$root/proc" "$root/dev/pts" "$root/dev"' EXIT
git clone -q "$source" "$root/root/pierce"
run() {
  chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin CI=true \
    bash -c "cd /root/pierce && $1"
}
run ./demo.sh
lap "./demo.sh"
run ./demo.sh >/dev/null
lap "./demo.sh again"
run ./test.sh
lap "./test.sh"
run "./test.sh -L house" >/dev/null
lap "./test.sh -L house again"
