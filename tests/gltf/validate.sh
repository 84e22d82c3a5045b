#!/bin/sh
# Checks glTF files with the Khronos validator: tests/gltf/validate.sh FILE...
# Ends with 0 if all are free of errors and warnings, with 1 if not, with 77 (CTest: skipped) if it cannot run here.
set -eu
here=$(CDPATH='' cd "$(dirname "$0")" && pwd)

need() {
    command -v "$1" >/dev/null 2>&1 && return
    echo "skipped: $1 is not installed"
    exit 77
}
need node

# npm writes .package-lock.json last; one process at a time installs, as tests may run side by side.
installed=$here/node_modules/.package-lock.json
if [ ! -f "$installed" ] || [ "$here/package-lock.json" -nt "$installed" ]; then
    need npm
    lock=$here/node_modules.lock.tmp
    tries=0
    until mkdir "$lock" 2>/dev/null; do
        tries=$((tries + 1))
        if [ "$tries" -gt 120 ]; then
            echo "skipped: another run seems to install the validator; if none does, remove $lock"
            exit 77
        fi
        sleep 1
    done
    trap 'rmdir "$lock" 2>/dev/null || true' EXIT
    trap 'exit 130' INT TERM
    if [ ! -f "$installed" ] || [ "$here/package-lock.json" -nt "$installed" ]; then
        if ! log=$(npm ci --prefix "$here" --prefer-offline --no-audit --no-fund 2>&1); then
            echo "$log" >&2
            echo "skipped: npm could not fetch the validator (see above)"
            exit 77
        fi
        touch "$installed"
    fi
    rmdir "$lock"
    trap - EXIT INT TERM
fi
exec node "$here/validate.mjs" "$@"
