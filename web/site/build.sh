#!/usr/bin/env bash
# build.sh ROOT BUILD: builds the documentation site in BUILD/site/html. BUILD has the Python package.
set -euo pipefail

root=$1
site=$2/site
version=$(sed -n 's/^project(vat VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
mkdir -p -- "$site"
(cd -- "$root" && { cat web/site/Doxyfile && printf 'OUTPUT_DIRECTORY = "%s"\n' "$site"; } | doxygen -)
/usr/bin/python3 -B "$root/web/site/stage.py" "$root" "$site/source" "$site/xml"
VAT_SITE_VERSION=$version VAT_SITE_DOXYGEN=$site/xml PYTHONPATH=$2/python /usr/bin/python3 -B -m sphinx \
  -c "$root/web/site" -d "$site/state" -j auto -q -W --keep-going "$site/source" "$site/html"
printf '%s\n' "$site/html/index.html"
