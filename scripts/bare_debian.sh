#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# README's lines for Python on a Debian 12 that has g++, python3-dev and python3-venv and no headers
# of libraries: makes one in a folder (debootstrap), clones this repository's HEAD into it, pastes
# the lines, compares what they print, and runs some tests of the package. Then again with the
# libraries' headers installed. Fails if it takes more than 240 s of processor time (two minutes of
# two cores) from the clone to the first answer. Needs root, a network, debootstrap, 2 GB of disk.
#
# usage: bare_debian.sh FOLDER       FOLDER must not exist; it is left for a look
set -euo pipefail
if [ $# -ne 1 ] || [ -e "$1" ]; then
  sed -n 's/^# usage: /usage: /p' "$0" >&2
  exit 2
fi
source=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
root=$(cd "$1" && pwd)
mirror=${MIRROR:-http://deb.debian.org/debian}

debootstrap --variant=minbase --include=ca-certificates,g++,python3,python3-dev,python3-venv \
  bookworm "$root" "$mirror" >/dev/null
for file in apt/apt.conf pip.conf resolv.conf ssl/certs/ca-certificates.crt; do
  cp "/etc/$file" "$root/etc/$file" 2>/dev/null || true # as this machine reaches the network
done
mount --bind /proc "$root/proc"
mount --bind /dev "$root/dev"
trap 'umount "$root/proc" "$root/dev"' EXIT
run() {
  chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"
}

# block LANGUAGE: the first such block of README.md's part on Python.
block() {
  sed -n '/^## In Python/,/^## On/p' "$source/README.md" | sed -n "/^\`\`\`$1\$/,/^\`\`\`\$/p;" |
    sed '1d;/^```$/,$d'
}
mkdir -p "$root/lines"
block sh >"$root/lines/install.sh"
block python >"$root/lines/answer.py"
block text >"$root/lines/answer.txt"
[ -s "$root/lines/install.sh" ] && [ -s "$root/lines/answer.py" ] && [ -s "$root/lines/answer.txt" ]
cat >"$root/lines/paste.sh" <<'END'
set -e
cd /root/pierce
. /lines/install.sh
python /lines/answer.py >/lines/printed.txt
END

cat >"$root/lines/tests.sh" <<'END'
set -e
cd /root
. pierce/venv/bin/activate
pierce --version
python -m pierce --help >/dev/null
pip install --quiet pytest hypothesis
tests=pierce/bindings/python/tests
python -m pytest --quiet -p no:cacheprovider -c pierce/pyproject.toml --rootdir pierce \
  $tests/test_{arrays,errors,exact,files,package,questions}.py
END

# try NAME CARRIED: from a clone to the first answer, and what must hold then; so many libraries are
# to come from third_party/.
try() {
  rm -rf "$root/root/pierce"
  local TIMEFORMAT="%R %U %S"
  { time {
    git clone -q "$source" "$root/root/pierce"
    run bash /lines/paste.sh >"$root/lines/$1.log" 2>&1
  }; } 2>"$root/lines/$1.times" || {
    tail -n 30 "$root/lines/$1.log" >&2
    exit 1
  }
  diff "$root/lines/answer.txt" "$root/lines/printed.txt"
  local carried
  carried=$(grep -oh '/third_party/[A-Za-z_]*' "$root"/root/pierce/build/python/*/build.ninja |
    sort -u | wc -l)
  [ "$carried" -eq "$2" ] ||
    { echo "bare_debian: $1: $carried libraries of third_party/ instead of $2" >&2 && exit 1; }
  awk -v name="$1" '{ cpu = $2 + $3
    printf "bare_debian: %s: %.0f s from clone to answer, %.0f s of processor time\n", name, $1, cpu
    exit cpu > 240 }' "$root/lines/$1.times" || slow=1
  run bash /lines/tests.sh
}
slow=0
try "without -dev packages" 7
run apt-get -qq update
run apt-get -qq install -y --no-install-recommends pkg-config libboost-dev libhwy-dev libfmt-dev \
  libfast-float-dev libcli11-dev libstb-dev nlohmann-json3-dev >/dev/null 2>&1
try "with -dev packages" 0
[ "$slow" = 0 ] || { echo "bare_debian: more than 240 s of processor time" >&2 && exit 1; }
