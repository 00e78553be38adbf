#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Builds the documentation site with mkdocs-material, strictly, and follows every link of it:
# build/site/html/VERSION/index.html, and build/site/html/index.html that leads there. Static: any
# server serves it. A few seconds; the first time with a network, for PyPI (exit status 77: none).
#
#   scripts/site.sh
set -euo pipefail
cd "$(dirname "$0")/.."
to=build/site
version=$(tr -d '[:space:]' <VERSION)
mkdir -p "$to"
if ! "$to/venv/bin/mkdocs" --version >/dev/null 2>&1; then
  python3 -m venv "$to/venv"
  "$to/venv/bin/pip" install --quiet --disable-pip-version-check 'mkdocs-material==9.*' || exit 77
fi
export PIERCE_SITE_PAGES=$PWD/$to/pages PIERCE_SITE_HTML=$PWD/$to/html/$version
"$to/venv/bin/python" scripts/site/stage.py . "$PIERCE_SITE_PAGES"
NO_MKDOCS_2_WARNING=1 "$to/venv/bin/mkdocs" build --strict --quiet
printf '[{"version": "%s", "title": "%s", "aliases": []}]\n' "$version" "$version" \
  >"$to/html/versions.json"
cat >"$to/html/index.html" <<EOF
<!doctype html><title>pierce</title><meta http-equiv="refresh" content="0; url=$version/start.html">
EOF
"$to/venv/bin/python" scripts/site/check.py . "$PIERCE_SITE_PAGES" "$PIERCE_SITE_HTML"
