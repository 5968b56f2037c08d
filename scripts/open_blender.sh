#!/usr/bin/env bash
# open_blender.sh KEYHOLE ARGUMENT...: opens Blender with the add-on of this folder, linked and enabled, which renders
# with the program KEYHOLE.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
command -v blender >/dev/null || { echo "open_blender.sh: found no program 'blender'" >&2; exit 1; }

KEYHOLE=$(readlink -f "$1")
export KEYHOLE
shift
version=$(blender --version | sed -n '1s/^Blender \([0-9]*\.[0-9]*\).*/\1/p')
addons=${BLENDER_USER_SCRIPTS:-${XDG_CONFIG_HOME:-$HOME/.config}/blender/$version/scripts}/addons
mkdir -p "$addons"
ln -sfn "$root/blender/keyhole" "$addons/keyhole"
exec blender --addons keyhole "$@"
