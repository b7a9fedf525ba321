#!/usr/bin/env bash
# Installs a build, moves it, and uses the program, its data, manual and completion.
# Usage: installed.sh BUILD SOURCES
set -euo pipefail
build=$1 sources=$2
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT

fail() {
  printf 'installed.sh: %s\n' "$*" >&2
  exit 1
}

# expect NAME EXPECTED ACTUAL
expect() { [[ $2 == "$3" ]] || fail "$1: '$3', expected '$2'"; }

cmake --install "$build" --prefix "$work/first" >"$work/log" 2>&1 || fail "$(<"$work/log")"
mv "$work/first" "$work/moved"
vat=$work/moved/bin/vat
data=$work/moved/share/vat

for folder in scenes web; do
  expect "$folder" "\"$folder\": \"$data/$folder\"" \
    "$("$vat" serve --print-config | grep -o "\"$folder\": \"/[^\"]*\"")"
done
[[ $("$vat" validate dam-break) == *': valid'* ]] || fail "the catalogue has no dam-break"
for file in web/index.html web/export/page.html scenes/meshes schemas/scene_format.json; do
  [[ -e $data/$file ]] || fail "no $file"
done

for page in vat vat-serve vat-simulate; do
  manual=$(gzip -dc "$work/moved/share/man/man1/$page.1.gz") || fail "no manual of $page"
  [[ $manual == *".TH ${page^^} "* && $manual == *'.SH OPTIONS'* ]] || fail "manual of $page"
done

cmake -G Ninja -S "$sources/tests/cli/library" -B "$work/example" \
  -DCMAKE_PREFIX_PATH="$work/moved" >"$work/log" 2>&1 &&
  cmake --build "$work/example" >>"$work/log" 2>&1 || fail "$(<"$work/log")"
# Free fall: -9.81 / 2 * 0.5^2 m.
expect "a program with the library" "after 0.5 s: -1.22625 m" "$("$work/example/fall")"
expect "an external simulator" "the ball has 1.62 m/s" "$("$work/example/pendulum")"
# watch PROGRAM: runs the watcher with a server.
watch() {
  python3 -B "$sources/tests/clients/run_example.py" "$vat" "$sources/tests/cli/library/watcher.txt" \
    "$1" ball >"$work/log" 2>&1 || fail "$(<"$work/log")"
}
watch "$work/example/watcher"
pkg_config=$(find "$work/moved" -name vat-client.pc)
libraries=$(PKG_CONFIG_PATH=${pkg_config%/*} pkg-config --libs vat-client)
# shellcheck disable=SC2086 # several words
c++ -o "$work/linked" "$work/example/CMakeFiles/watcher.dir/watcher.cpp.o" $libraries ||
  fail "vat-client.pc lacks a library"
watch "$work/linked"
shown=$(sed -n '/^```cpp$/,/^```$/{/^```/d;p}' "$sources/protocol/client/README.md")
[[ -n $shown && $(<"$sources/tests/cli/library/watcher.cpp") == *"$shown"* ]] ||
  fail "protocol/client/README.md shows another program than watcher.cpp"
while read -r line; do
  grep -qxF "$line" "$sources/tests/cli/library/CMakeLists.txt" ||
    fail "docker/debian/README.md shows another line than tests/cli/library/CMakeLists.txt: $line"
done < <(sed -n '/^```cmake$/,/^```$/{/^```/d;p}' "$sources/docker/debian/README.md")

# shellcheck source=/dev/null
source "$work/moved/share/bash-completion/completions/vat"
# complete_words WORD...: prints the completions of the last word.
complete_words() {
  COMP_WORDS=(vat "$@") COMP_CWORD=$#
  _vat "$vat"
  printf '%s ' "${COMPREPLY[@]}"
}
expect 'completion of a scene' 'dam-break ' "$(complete_words simulate dam)"
expect 'completion of a command' 'serve ' "$(complete_words se)"
# complete_in_zsh WORD...: the same with the function for zsh, whose builtins are replaced.
complete_in_zsh() {
  zsh -f -c 'compadd() { print -rn -- "${(P)2} " }; _files() { print -rn files }
    completion=$1; shift; words=("$@"); CURRENT=$#; source "$completion"' \
    zsh "$work/moved/share/zsh/vendor-completions/_vat" "$vat" "$@"
}
expect 'completion of a scene in zsh' 'dam-break ' "$(complete_in_zsh simulate dam)"
expect 'completion of an option in zsh' '--level ' "$(complete_in_zsh simulate dam-break --le)"
expect 'completion of a file in zsh' 'files' "$(complete_in_zsh validate ./x)"
