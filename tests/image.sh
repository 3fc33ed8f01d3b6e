#!/usr/bin/env bash
# Runs what ./image lays out as a container does: alone in an empty root that is read-only but for /data, without any right.
# Called by `./check image`. Needs user namespaces, which it takes to look like root and to mount.
set -euo pipefail

fail() {
    echo "image: $*" >&2
    [ -z "${server:-}" ] || stop || true
    exit 1
}

if [ "${1:-}" != inside ]; then
    root=${1:?usage: image.sh FOLDER}
    exec unshare --user --map-root-user --mount --fork --kill-child "$0" inside "$(realpath "$root")"
fi
root=$2

# All that there is, and nothing that it would need besides.
files=$(cd "$root" && find . -not -type d | sort | tr '\n' ' ')
[ "$files" = "./etc/ssl/certs/ca-certificates.crt ./include/stickslip.h ./lib/libstickslip.a ./lib/libstickslip.so ./lib/libstickslip.so.0 ./libstickslip_fmu.so ./licences/LICENSE ./licences/THIRD-PARTY.txt ./stickslip " ] || fail "unexpected files: $files"
if readelf --program-headers "$root/stickslip" | grep -q INTERP; then fail "the program is not static"; fi

mount --bind "$root" "$root"
mount -o remount,bind,ro "$root"
mount -t tmpfs tmpfs "$root/data"
if touch "$root/made" 2>/dev/null; then fail "the root can be written to"; fi

# As user 65532, in the root, with the environment of the image but for the port. The user has no right left once the program runs.
read -ra environment < <(sed -n 's/^ENV //p' "$(dirname "$0")/../Dockerfile")
[[ " ${environment[*]} " == *" STICKSLIP_LISTEN=0.0.0.0:8080 "* ]] || fail "the image does not listen for the port that is published"
alone() {
    env --ignore-environment PATH="$PATH" "${environment[@]}" STICKSLIP_LISTEN="${listen:-0.0.0.0:0}" \
        unshare --user --map-user=65532 --map-group=65532 --root="$root" --wd=/data /stickslip "$@"
}
start() {
    exec {lines}< <(alone serve 2>/dev/null)
    server=$!
    made= line=
    until [[ $line == *"listens on"* ]]; do
        read -r -t 30 -u "$lines" line || fail "the service does not start"
        [[ $line != "key "* ]] || made=${line#key }
    done
    listen=$(grep -o '0\.0\.0\.0:[0-9]*' <<<"$line")
    base=http://127.0.0.1:${listen#*:}
}
# Of the unshare that became the program.
stop() {
    kill -TERM "$(pgrep -P "$server" || echo "$server")"
    while kill -0 "$server" 2>/dev/null; do sleep 0.05; done
    server=
}
call() { curl --silent --fail --max-time 10 -H "authorization: Bearer $key" "$@"; }
post() { call "$base$1" -H 'content-type: application/json' -d "$2"; }

start
key=$made
[ -n "$key" ] || fail "the first start makes no key"
[ "$(curl --silent --output /dev/null --write-out '%{http_code}' "$base/contacts")" = 401 ] || fail "it answers without a key"
process=$(pgrep -f "^/stickslip serve" -P "$server" || echo "$server")
grep -q '^ *65532 ' "/proc/$process/uid_map" || fail "the process is not user 65532"
grep -q '^CapEff:[[:space:]]*0000000000000000$' "/proc/$process/status" || fail "the process has rights"
alone healthcheck || fail "healthcheck finds it unwell"
contact='{"profile": {"type": "sphere", "radius": 0.01}, "material": {"effective": {"e_star": 1e11, "g_star": 8e10}},
    "friction": 0.3, "preload": {"normal_force": 10}}'
id=$(post /contacts "$contact" | grep -o '"id":"[^"]*"' | cut -d'"' -f4)
post "/contacts/$id/move" '{"displacement": 1e-8}' >/dev/null || fail "it makes no move"
alone backup copy.db || fail "no backup beside the service"
alone check || fail "check beside the service"
stop
if alone healthcheck 2>/dev/null; then fail "healthcheck finds a service that has ended"; fi
alone check --store sqlite:copy.db || fail "the backup is not sound"

listen=
start
[ -z "$made" ] || fail "the second start makes another key"
call "$base/contacts/$id" | grep -q '"sequence":1' || fail "the move is gone after a restart"
stop

# In a closed network, without keys.
listen=
environment+=(STICKSLIP_INSECURE=true)
start
curl --silent --fail --max-time 10 "$base/contacts" >/dev/null || fail "it needs a key in a closed network"
stop

listen=
if refusal=$(alone serve --store sqlite:/elsewhere.db 2>&1); then fail "it writes outside /data"; fi
grep -qi "read-only" <<<"$refusal" || fail "outside /data: $refusal"
# The certificates are found: it gets as far as connecting.
refusal=$(alone check --store 'postgres://nobody@127.0.0.1:1/none?sslmode=verify-full' 2>&1) && fail "a database at port 1"
if grep -q "certificate authority" <<<"$refusal"; then fail "$refusal"; fi
echo "image: $(du --bytes "$root/stickslip" | cut -f1) bytes, alone in its root, without rights: sound"
