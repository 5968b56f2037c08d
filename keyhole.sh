#!/usr/bin/env bash
# keyhole.sh ARGUMENT...: sets Keyhole up if need be, and runs it. For example: ./keyhole.sh render scenes/box.yaml
set -euo pipefail
root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")

unset KEYHOLE_PRESET
"$root/scripts/build.sh" keyhole
exec "$root/build/keyhole" "$@"
