#!/usr/bin/env bash
# vat-agones serve [OPTION...]: runs a server as a game server of Agones.
#
# It reports the server's readiness and health to the sidecar of Agones, and asks for the removal of
# the pod after the server has ended, or if no client has been connected for AGONES_EMPTY_SECONDS
# after the first one (default 300). It needs no other program, because the image has no HTTP client.
set -euo pipefail

server=${VAT_PORT:-8080}
sidecar=${AGONES_SDK_HTTP_PORT:-9358}
empty_seconds=${AGONES_EMPTY_SECONDS:-300}
interval=1 # [s]

# request PORT METHOD PATH [HEADER]: prints the body of the response. Fails if there is no response
# with status 200.
request() (
  body=
  [[ $2 != POST ]] || body='{}'
  exec 3<>"/dev/tcp/127.0.0.1/$1" || exit
  printf '%s\r\n' "$2 $3 HTTP/1.1" 'Host: 127.0.0.1' 'Connection: close' ${4:+"$4"} \
    'Content-Type: application/json' "Content-Length: ${#body}" '' >&3 || exit
  printf '%s' "$body" >&3
  read -r -t 5 _ status _ <&3 && [[ $status == 200 ]] || exit
  while read -r -t 5 line <&3 && [[ $line != $'\r' ]]; do :; done
  cat <&3
) 2>/dev/null

get() { request "$server" GET "$@"; }
report() { request "$sidecar" POST "/$1" >/dev/null; }

# Prints the number of clients, or nothing if the server does not tell.
client_count() {
  get /metrics "${VAT_ADMIN_TOKEN:+Authorization: Bearer $VAT_ADMIN_TOKEN}" |
    sed -n 's/^vat_clients \([0-9]*\).*/\1/p' || true
}

vat "$@" &
process=$!
trap 'kill -TERM "$process" 2>/dev/null || true' TERM INT

is_ready=
last_client= # time of the last moment with a client [s]
while kill -0 "$process" 2>/dev/null; do
  # The sidecar can start after this script, so a failed report is repeated.
  if [[ -z $is_ready ]]; then
    get /readyz >/dev/null && report ready && is_ready=yes
  else
    get /healthz >/dev/null && report health
  fi || true
  case $(client_count) in
    '') ;;
    0) [[ -z $last_client ]] || ((SECONDS - last_client < empty_seconds)) || kill -TERM "$process" ;;
    *) last_client=$SECONDS ;;
  esac
  sleep "$interval" &
  wait $! || true # a signal ends this wait at once
done
status=0
wait "$process" || status=$?
report shutdown || true # without it, Agones starts the container again
exit "$status"
