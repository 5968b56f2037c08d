#!/usr/bin/env bash
# Installs the Debian packages that Keyhole needs and that are missing; says nothing if none is.
# --ci: also what the checks of .ci/run need, and Blender if it can be had. --blender: Blender as well.
set -euo pipefail

packages=(
    g++ cmake ninja-build pkg-config
    libembree-dev libnanoflann-dev robin-map-dev libopenexr-dev libopenimageio-dev libyaml-cpp-dev libtbb-dev
    libcli11-dev libfmt-dev nlohmann-json3-dev libassimp-dev libpcg-cpp-dev libpng-dev libjpeg-dev zlib1g-dev
    libgtest-dev libgmock-dev)
[[ ${1-} != --ci ]] || packages+=(clang-14 libclang-rt-14-dev clang-format-14 clang-tidy-14 libopenmpi-dev openmpi-bin)
wanted=() # what is done without where it can't be had
case ${1-} in
    # Blender's Python needs numpy, which Blender's package only recommends.
    --ci) wanted=(blender python3-numpy pyflakes3) ;;
    --blender) packages+=(blender python3-numpy) ;;
esac

die() { printf '%s: %s\n' "${0##*/}" "$*" >&2; exit 1; }

command -v dpkg-query apt-get >/dev/null ||
    die "this is no Debian system; install the counterparts of: ${packages[*]}"

# A name counts as installed in any architecture; virtual and unknown names count as missing.
installed=$(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null |
    sed -n 's/^installed //p' || true)
missing=() lacking=()
for package in "${packages[@]}"; do
    grep -qxF "$package" <<<"$installed" || missing+=("$package")
done
for package in "${wanted[@]}"; do
    [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || lacking+=("$package")
done
[[ ${#missing[@]} -gt 0 || ${#lacking[@]} -gt 0 ]] || exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null ||
        { [[ ${#missing[@]} -eq 0 ]] && exit 0; die "neither root nor sudo here; run as root: apt-get install --no-install-recommends ${missing[*]}"; }
    as_root=(sudo)
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
run() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive "$@" >"$log" 2>&1; }

echo "Installing ${missing[*]} ${lacking[*]}" >&2
# Old package lists are no harm if what they name can still be fetched, so a failed update alone is no failure.
run apt-get update -o DPkg::Lock::Timeout=120 || { tail -n 5 "$log" >&2; echo "apt-get update failed; trying with the lists that are there" >&2; }
install() { run apt-get install -y --no-install-recommends -o DPkg::Lock::Timeout=120 "$@"; }
[[ ${#missing[@]} -eq 0 ]] || install "${missing[@]}" ||
    { tail -n 20 "$log" >&2; die "apt-get could not install: ${missing[*]}"; }
for package in "${lacking[@]}"; do
    install "$package" || echo "going on without $package, which apt-get could not install" >&2
done
