#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# Runs `pierce textbook` and puts what it prints between the markers in docs/textbook.md.
#
#   scripts/update_textbook_table.sh build/tool/pierce [RAYS [SEED]]
set -eu

if [ $# -lt 1 ] || [ ! -x "$1" ]; then
  echo "usage: $0 PIERCE [RAYS [SEED]], where PIERCE is the built tool" >&2
  exit 2
fi
page=$(dirname "$0")/../docs/textbook.md
table=$(mktemp)
trap 'rm -f "$table" "$table.page"' EXIT
"$1" textbook --rays "${2:-60000}" --seed "${3:-1}" >"$table"

awk -v table="$table" '
  /<!-- table: end -->/ { inside = 0; ended = 1 }
  !inside { print }
  /<!-- table: begin/ {
    inside = 1
    print ""
    while ((getline line < table) > 0) print line
    print ""
  }
  END { if (!ended) exit 1 }
' "$page" >"$table.page" || { echo "$page: the table markers are missing" >&2; exit 1; }
cat "$table.page" >"$page"
