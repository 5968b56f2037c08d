#!/usr/bin/env bash
# package.sh: builds keyhole_VERSION_ARCHITECTURE.deb in build-package, and has lintian check it where there is one.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)

KEYHOLE_PRESET=package "$root/scripts/build.sh" all
cd "$root/build-package"
rm -f ./*.deb
cpack -G DEB >&2
package=$(echo "$PWD"/keyhole_*.deb)
if command -v lintian >/dev/null; then
    lintian --fail-on error "$package"
else
    echo "package.sh: no lintian here: not checked" >&2
fi
echo "$package"
