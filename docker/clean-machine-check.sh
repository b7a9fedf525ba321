#!/usr/bin/env bash
# Tests a fresh clone on a bare Debian 12 machine: creates the machine in a folder (debootstrap,
# chroot), clones this checkout's HEAD into it, and runs `./vat serve` twice and `./vat test`. It
# prints the wall and processor time of each, without the download of Debian's packages. Needs root
# and debootstrap.
#
# From the environment: MIRROR (a Debian mirror), PORT (8080), CPUS (as for taskset: "0-1"), BASE
# (an earlier debootstrap folder to copy), LOGIN (root, or the name of a new user with sudo without
# a password). Proxies, extra certificates (NODE_EXTRA_CA_CERTS) and npm's registry are those of
# this machine.
set -euo pipefail

repository=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/..
mirror=${MIRROR:-http://deb.debian.org/debian}
port=${PORT:-8080}
cpus=${CPUS:-0-$(($(nproc) - 1))}
login=${LOGIN:-root}
work=$(mktemp -d -p /var/tmp)
machine=$work/machine
checkout="/srv/a folder/vat"
server=
processor=

say() { printf 'clean machine: %s\n' "$*"; }

fail() {
  say "FAILED: $*"
  exit 1
}

clean_up() {
  [[ -z $server ]] || kill "$server" 2>/dev/null || true
  for place in dev/shm dev/pts sys proc; do
    ! mountpoint -q "$machine/$place" || umount -l "$machine/$place"
  done
  rm -rf --one-file-system "$work"
}

make_machine() {
  if [[ -n ${BASE:-} ]]; then
    cp -a -- "$BASE" "$machine"
  else
    debootstrap --variant=minbase bookworm "$machine" "$mirror" >"$work/debootstrap.log" 2>&1 ||
      { cat "$work/debootstrap.log" && fail "debootstrap"; }
  fi
  # The machine has separate devices, so that faults in it cannot affect the devices of this machine.
  mount -t proc proc "$machine/proc"
  mount -t sysfs -o ro sysfs "$machine/sys" # OpenCL reads the topology of the processors
  mount -t devpts devpts "$machine/dev/pts"
  mount -t tmpfs tmpfs "$machine/dev/shm"
}

# Copies the network configuration of this machine, which a bare machine would have too.
give_network() {
  cp /etc/resolv.conf /etc/hosts "$machine/etc/"
  apt-config dump Acquire >"$machine/etc/apt/apt.conf.d/99network"
  if [[ -n ${NODE_EXTRA_CA_CERTS:-} ]]; then
    cp -L "$NODE_EXTRA_CA_CERTS" "$machine/etc/network-certificates.pem"
  fi
}

# Downloads packages without installing them.
fetch_packages() {
  local names
  names=$(awk '$1 ~ /^(build|web|test|try)$/ {print $2}' "$machine$checkout/docker/packages.txt")
  # shellcheck disable=SC2086 # one word for each package
  chroot "$machine" sh -c "apt-get update && apt-get install --yes --no-install-recommends \
    --download-only $(printf '%s ' $names)" >"$work/packages.log" 2>&1 ||
    { cat "$work/packages.log" && fail "packages"; }
}

# Sets `processor` to the processor seconds of all processes that this script has waited for.
measure_processor() {
  times >"$work/times" # not in a subshell, which has not waited for any process
  processor=$(awk 'NR == 2 {for (i = 1; i <= 2; ++i) {split($i, part, /[ms]/)
    sum += 60 * part[1] + part[2]} printf "%.0f", sum}' "$work/times")
}

make_user() {
  [[ $login != root ]] || return 0
  chroot "$machine" sh -c "apt-get update && apt-get install --yes --no-install-recommends sudo &&
    useradd --create-home $login" >"$work/user.log" 2>&1 || { cat "$work/user.log" && fail "user"; }
  printf '%s ALL=(ALL) NOPASSWD: ALL\n' "$login" >"$machine/etc/sudoers.d/$login"
  chroot "$machine" chown -R "$login" "$checkout"
}

# Runs a command in the checkout, with only the environment of a fresh login.
inside() {
  local environment=(TERM=dumb LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin) name
  environment+=("HOME=$(chroot "$machine" sh -c "echo ~$login")")
  for name in http_proxy https_proxy no_proxy npm_config_registry; do
    [[ -z ${!name:-} ]] || environment+=("$name=${!name}")
  done
  [[ -z ${NODE_EXTRA_CA_CERTS:-} ]] ||
    environment+=(NODE_EXTRA_CA_CERTS=/etc/network-certificates.pem)
  # shellcheck disable=SC2016 # expanded by the inner shell
  exec taskset -c "$cpus" env -i "${environment[@]}" chroot --userspec="$login" "$machine" \
    bash -c 'cd "$1" && shift && exec "$@"' bash "$checkout" "$@"
}

answers() { curl --silent --fail --output "${2:-/dev/null}" "http://127.0.0.1:$port$1"; }

# Starts the server, waits for its reply, checks the page, and stops the server. Sets `seconds`.
serve_once() {
  local start=$EPOCHREALTIME
  (inside ./vat serve --port "$port") >"$work/serve.log" 2>&1 &
  server=$!
  until answers /healthz; do
    kill -0 "$server" 2>/dev/null || { cat "$work/serve.log" && fail "./vat serve ended"; }
    sleep 0.1
  done
  seconds=$(awk "BEGIN {printf \"%.1f\", $EPOCHREALTIME - $start}")
  answers / "$work/page.html" || fail "no page at /"
  grep -q '<script' "$work/page.html" || fail "the page at / is not the viewer"
  kill -TERM "$server"
  wait "$server" || { cat "$work/serve.log" && fail "the server did not stop cleanly"; }
  server=
}

main() {
  local start before
  ((EUID == 0)) || fail "needs root, for chroot"
  ! answers / || fail "something answers on port $port already; set PORT"
  trap clean_up EXIT
  make_machine
  give_network
  git clone --quiet --no-local "$repository" "$machine$checkout"
  make_user
  fetch_packages
  say "bare Debian $(cat "$machine/etc/debian_version"), processors $cpus, as $login"
  measure_processor
  before=$processor
  serve_once
  measure_processor
  say "./vat serve from nothing: the page after $seconds s, $((processor - before)) CPU s"
  sed 's/^/    /' "$work/serve.log"
  serve_once
  say "./vat serve again: the page after $seconds s"
  start=$SECONDS
  before=$processor
  (inside ./vat test) >"$work/test.log" 2>&1 || { cat "$work/test.log" && fail "./vat test"; }
  grep -E 'tests passed|Total Test time' "$work/test.log"
  measure_processor
  say "./vat test: $((SECONDS - start)) s, $((processor - before)) CPU s"
  start=$EPOCHREALTIME
  (inside ./vat prepare test) >"$work/test.log" 2>&1 || { cat "$work/test.log" && fail "prepare"; }
  say "nothing to build: $(awk "BEGIN {printf \"%.1f\", $EPOCHREALTIME - $start}") s"
}

main "$@"
