#!/bin/sh
# Writes compressed manual pages of the program and its commands.
# Usage: man_pages.sh PROGRAM VERSION FOLDER
set -eu
program=$1 version=$2 folder=$3

# page NAME HELP_OPTION: help2man takes the title from the name of the program.
page() {
  ln -sf -- "$program" "$work/$1"
  # shellcheck disable=SC2086 # a command and its option
  name=$("$program" $2 | sed -n '1{s/.*/\l&/;s/\.$//;p}')
  help2man --no-info --help-option="$2" --version-string="$version" --name="$name" "$work/$1" |
    gzip -9n >"$folder/$1.1.gz"
}

work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
mkdir -p -- "$folder"
page vat --help
for command in $("$program" complete -- ''); do
  page "vat-$command" "$command --help"
done
