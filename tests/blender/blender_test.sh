#!/usr/bin/env bash
# blender_test.sh KEYHOLE [PART OF A NAME]: the tests of this folder. Skipped (77) where there is no Blender.
set -uo pipefail
here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
addon=$here/../../blender/keyhole

long=$(find "$addon" -name '*.py' -exec awk 'END { if (NR > 200) print FILENAME ": " NR " lines, expected 200" }' {} \;)
[[ -z $long ]] || { echo "$long"; exit 1; }
for flakes in "python3 -m pyflakes" "/usr/bin/python3 -m pyflakes" ""; do
    [[ -n $flakes ]] || { echo "no pyflakes: not checked"; break; }
    $flakes --version >/dev/null 2>&1 || continue
    $flakes "$addon" "$here" || exit 1
    break
done
command -v blender >/dev/null || { echo "skipped: there is no Blender (apt-get install blender)"; exit 77; }

# Two of them: one alone leaves a core idle between its renders.
KEYHOLE_SHARD=1/2 blender -b --factory-startup -noaudio -P "$here/run.py" -- "$@" &
KEYHOLE_SHARD=0/2 blender -b --factory-startup -noaudio -P "$here/run.py" -- "$@"
status=$?
wait $! && exit $status
