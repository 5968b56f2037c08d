#!/usr/bin/env bash
# zip_test.sh KEYHOLE BUILD CMAKE: the zip installs into a Blender that has never seen it, and `open_blender.sh` finds
# the add-on without. Skipped (77) where there is no Blender.
set -euo pipefail
command -v blender >/dev/null || { echo "skipped: there is no Blender (apt-get install blender)"; exit 77; }
here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
keyhole=$(readlink -f "$1")
build=$(readlink -f "$2")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export BLENDER_USER_SCRIPTS=$scratch/scripts BLENDER_USER_CONFIG=$scratch/config
mkdir -p "$BLENDER_USER_SCRIPTS" "$BLENDER_USER_CONFIG"

"$3" --build "$build" --target blender-addon
cat >"$scratch/install.py" <<PYTHON
import bpy
bpy.ops.preferences.addon_install(filepath="$build/keyhole-blender.zip")
bpy.ops.preferences.addon_enable(module="keyhole")
bpy.context.preferences.addons["keyhole"].preferences.program = "$keyhole"
import keyhole.preferences
assert keyhole.__file__.startswith("$BLENDER_USER_SCRIPTS"), keyhole.__file__
assert keyhole.preferences.program() == "$keyhole"
bpy.context.scene.render.engine = "KEYHOLE"
bpy.ops.preferences.addon_disable(module="keyhole")
print("installed")
PYTHON
blender -b --factory-startup -noaudio -P "$scratch/install.py" | tee "$scratch/said"
grep -qx installed "$scratch/said"

rm -rf "$BLENDER_USER_SCRIPTS"
cat >"$scratch/opened.py" <<PYTHON
import bpy
bpy.context.scene.render.engine = "KEYHOLE"
import keyhole.preferences
assert keyhole.preferences.program() == "$keyhole"
print("opened")
PYTHON
"$here/../../scripts/open_blender.sh" "$keyhole" -b -noaudio -P "$scratch/opened.py" | tee "$scratch/said"
grep -qx opened "$scratch/said"
