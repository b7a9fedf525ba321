#!/usr/bin/env bash
# Tests the Debian packages in a bare Debian 12 that systemd boots in a folder: the service serves the
# page, keeps its sessions when the package is upgraded, and leaves nothing when it is purged; Python
# finds its package. Needs root, debootstrap, systemd-container and lintian.
# Usage: package-check.sh vat_VERSION_amd64.deb python3-vat_VERSION_amd64.deb
#
# From the environment: MIRROR (a Debian mirror), BASE (an earlier debootstrap folder to copy).
set -euo pipefail

package=$(readlink -f -- "$1")
python_package=$(readlink -f -- "$2")
mirror=${MIRROR:-http://deb.debian.org/debian}
work=$(mktemp -d -p /var/tmp)
machine=$work/machine

say() { printf 'package check: %s\n' "$*"; }

fail() {
  say "FAILED: $*"
  exit 1
}

clean_up() {
  ! mountpoint -q "$machine/proc" || umount -l "$machine/proc"
  rm -rf --one-file-system "$work"
}

make_machine() {
  if [[ -n ${BASE:-} ]]; then
    cp -a -- "$BASE" "$machine"
  else
    debootstrap --variant=minbase bookworm "$machine" "$mirror" >"$work/log" 2>&1 ||
      { cat "$work/log" && fail "debootstrap"; }
  fi
  cp /etc/resolv.conf /etc/hosts "$machine/etc/"
  apt-config dump Acquire >"$machine/etc/apt/apt.conf.d/99network"
}

# Makes a package with the same content and a later version.
make_upgrade() {
  dpkg-deb --raw-extract "$package" "$work/upgrade"
  sed -i 's/^Version: .*/&+1/' "$work/upgrade/DEBIAN/control"
  dpkg-deb --root-owner-group --build "$work/upgrade" "$machine/srv/upgrade.deb" >/dev/null
}

install_package() {
  cp -- "$package" "$machine/srv/vat.deb"
  cp -- "$python_package" "$machine/srv/python3-vat.deb"
  mount -t proc proc "$machine/proc"
  chroot "$machine" sh -c 'apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install --yes \
    --no-install-recommends systemd-sysv dbus curl /srv/vat.deb /srv/python3-vat.deb' >"$work/log" 2>&1 ||
    { cat "$work/log" && fail "apt-get install"; }
  umount "$machine/proc"
}

# The machine runs this after its start, and then stops.
write_check() {
  cat >"$machine/srv/make.jsonl" <<'END'
{"connect": "a"}
{"call": "session.create", "params": {"name": "kept", "scene": {"format": "vat.scene/1", "materials": [{"name": "wood", "density": 600}], "bodies": [{"name": "ball", "kind": "rigid", "material": "wood", "shape": {"type": "sphere", "radius": 0.1}, "spacing": 0.05}]}}, "result": {"session": "s2"}}
{"call": "session.join", "params": {"session": "s2"}}
{"call": "control.pause"}
{"call": "control.reset"}
{"call": "control.step", "params": {"ticks": 25}, "result": {"tick": 25}}
END
  cat >"$machine/srv/find.jsonl" <<'END'
{"connect": "a"}
{"call": "session.list", "result": {"sessions": [{"session": "s1"}, {"session": "s2", "name": "kept"}]}}
{"call": "session.join", "params": {"session": "s2"}, "result": {"description": {"bodies": [{"name": "ball", "body": "$ball"}]}}}
{"call": "state.query", "params": {"bodies": ["$ball"]}, "result": {"time": {"$near": [0.5, 1e-9]}, "bodies": [{"velocity": {"$near": [[0, 0, -4.905], 1e-9]}}]}}
END
  cat >"$machine/srv/check.py" <<'END'
import vat

simulation = vat.Simulation("dam-break")
simulation.advance(0.1)
assert simulation["column"].positions.shape == (2000, 3)
assert "<iframe" in simulation._repr_html_()
with vat.Client("ws://127.0.0.1:8080/ws") as client:
    client.join()
    client.call("frames.subscribe")
    assert client.next_frame().bodies
END
  cat >"$machine/srv/check.sh" <<'END'
set -eux
trap 'test $? = 0 || journalctl --no-pager --unit vat | tail -n 20' EXIT
ready() { curl --silent --fail --retry 20 --retry-delay 1 --retry-all-errors http://127.0.0.1:8080/readyz; }
ready
curl --silent --fail http://127.0.0.1:8080/ | grep -q '<script'
systemd-analyze security vat.service | tail -n 1
vat script --server ws://127.0.0.1:8080 /srv/make.jsonl
python3 /srv/check.py
apt-get purge --yes python3-vat # it needs the same version of vat
before=$(systemctl show --property MainPID vat)
apt-get install --yes /srv/upgrade.deb
ready
test "$before" != "$(systemctl show --property MainPID vat)"
vat script --server ws://127.0.0.1:8080 /srv/find.jsonl
journalctl --unit vat | grep 'vat is at http://127.0.0.1:8080/'
test -d /var/lib/private/vat
apt-get purge --yes vat
if systemctl is-active vat; then exit 1; fi
test ! -e /var/lib/private/vat
test ! -e /etc/vat/vat.conf
echo passed
END
  cat >"$machine/etc/systemd/system/check.service" <<'END'
[Unit]
After=vat.service
SuccessAction=poweroff-force
FailureAction=poweroff-force
[Service]
Type=oneshot
ExecStart=/bin/sh /srv/check.sh
StandardOutput=file:/srv/check.log
StandardError=file:/srv/check.log
[Install]
WantedBy=multi-user.target
END
  ln -s /etc/systemd/system/check.service "$machine/etc/systemd/system/multi-user.target.wants/"
}

# systemd-nspawn removes its folder in /run only from a file system in memory.
boot() {
  # shellcheck disable=SC2016 # expanded by the inner shell
  timeout 300 unshare --mount sh -c 'mkdir -p /run/systemd/nspawn &&
    mount -t tmpfs tmpfs /run/systemd/nspawn &&
    exec systemd-nspawn --quiet --directory "$1" --keep-unit --register=no --boot' sh "$machine" \
    >"$work/boot.log" 2>&1 </dev/null || true
}

main() {
  ((EUID == 0)) || fail "needs root"
  trap clean_up EXIT
  lintian --fail-on error --allow-root "$package" "$python_package" || fail "lintian"
  make_machine
  install_package
  make_upgrade
  write_check
  boot
  sed 's/^/    /' "$machine/srv/check.log" || { cat "$work/boot.log" && fail "no boot"; }
  grep -qx passed "$machine/srv/check.log" || fail "see above"
  say "passed"
}

main
