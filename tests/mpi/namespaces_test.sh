#!/usr/bin/env bash
# Ranks in network namespaces of their own, which share nothing but cables: they make the picture that one process makes,
# and end with checkpoints where a cable is pulled. namespaces_test.sh KEYHOLE KEYHOLE_MPI SCENES
# Exit code 77: can't be tried here.
set -euo pipefail
keyhole=$1 keyhole_mpi=$2 scenes=$3
id=kh$$

skip() { echo "skipped: $*"; exit 77; }
fail() { echo "FAILED: $*"; tail -n 50 "$dir"/log "$dir"/err.* 2>/dev/null || true; exit 1; }
command -v ip >/dev/null || skip "no ip (iproute2)"
command -v mpirun >/dev/null && mpirun --version | grep -q 'Open MPI' || skip "no mpirun of Open MPI (openmpi-bin)"
ip netns add "${id}n0" 2>/dev/null || skip "ip netns add isn't permitted"

dir=$(mktemp -d)
clean_up() {
    for i in 0 1 2 3; do
        ip netns pids "${id}n$i" 2>/dev/null | xargs -r kill -9 2>/dev/null || true
        ip netns delete "${id}n$i" 2>/dev/null || true
    done
    rm -rf "$dir"
}
trap clean_up EXIT

# Three hosts, and a fourth with mpirun and the switch that all are plugged into.
switch() { ip -n "${id}n0" "$@"; }
{ switch link add switch type bridge && switch link set switch up && switch link set lo up &&
    switch addr add 10.97.0.254/24 dev switch; } || skip "no bridges here"
for i in 1 2 3; do
    ip netns add "${id}n$i"
    switch link add "port$i" type veth peer name eth0 netns "${id}n$i"
    switch link set "port$i" master switch up
    ip -n "${id}n$i" addr add "10.97.0.$i/24" dev eth0
    ip -n "${id}n$i" link set eth0 up
    ip -n "${id}n$i" link set lo up
done

# In place of ssh: HOST COMMAND... Hosts have names and temporary files of their own.
cat >"$dir/agent" <<EOF
#!/bin/sh
i=\${1##*.}
shift
export TMPDIR=$dir/tmp.\$i
mkdir -p \$TMPDIR
exec ip netns exec ${id}n\$i unshare --uts sh -c "echo host\$i >/proc/sys/kernel/hostname; \$*"
EOF
# Each rank's messages in a file: a host that is cut off can't send them to mpirun.
cat >"$dir/rank" <<EOF
#!/bin/sh
exec $keyhole_mpi "\$@" 2>$dir/err.\$OMPI_COMM_WORLD_RANK
EOF
chmod +x "$dir/agent" "$dir/rank"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_plm_rsh_agent=$dir/agent
export OMPI_MCA_btl=tcp,self OMPI_MCA_btl_tcp_if_include=10.97.0.0/24 OMPI_MCA_oob_tcp_if_include=10.97.0.0/24
export KEYHOLE_MPI_PATIENCE=60
export ASAN_OPTIONS=detect_leaks=0 # what Open MPI's plug-ins forget is told of places that are unloaded by then
ranks() { # ARGUMENTS of keyhole-mpi
    ip netns exec "${id}n0" timeout -k 1 120 mpirun --host 10.97.0.1,10.97.0.2,10.97.0.3 -np 3 -wdir "$dir" \
        -x KEYHOLE_MPI_PATIENCE -x ASAN_OPTIONS "$dir/rank" "$@" >"$dir/log" 2>&1
}
same() { # A B
    "$keyhole" diff "$1" "$2" | grep -q '"relmse":0.0,.*"rms_rel":0.0,' || fail "$1 and $2 differ"
}
cd "$dir"

small="-q --no-png -t 1 --resolution 24x16 --method mps --spp 1 --passes 5 --mutations 3k -D chains=50
    -D brightness_samples=2000 -D importons=2000 -D photon_memory=512KiB -D cache_rays=64
    -D brightness_error=0"
for scene in box rooms lantern; do
    # shellcheck disable=SC2086 # words
    "$keyhole" render "$scenes/$scene.yaml" $small -o "$scene.exr"
    # shellcheck disable=SC2086
    ranks render "$scenes/$scene.yaml" $small -o parts.exr || fail "three hosts: $scene"
    same "$scene.exr" parts.exr
    echo "$scene: three hosts make the picture of one"
done

cat >scene.yaml <<EOF
film: {resolution: [24, 16]}
camera: {from: [0, 0, 3], to: [0, 0, 0]}
materials: {white: {type: diffuse}}
shapes:
  - {type: sphere, material: white}
  - {type: rectangle, corner: [-1, 3, -1], u: [2, 0, 0], v: [0, 0, 2], emission: {power: 60}}
EOF
long="render scene.yaml -q --no-png --method path --passes 100 --spp 250"
files=(a.checkpoint.exr a.checkpoint.1.exr a.checkpoint.2.exr)
wait_for() { # SECONDS COMMAND...: until it succeeds
    local until=$((SECONDS + $1))
    shift
    until "$@"; do
        [ $SECONDS -lt $until ] || return 1
        sleep 0.1
    done
}
all_written() { for f in "${files[@]}"; do [ "$f" -nt start ] || return 1; done; } # since the file "start"

# The cable of rank 2's host. Both sides notice.
touch start
KEYHOLE_MPI_PATIENCE=2 ranks $long -t 1 --checkpoint 0 -o a.exr &
job=$!
wait_for 30 all_written || fail "no checkpoints"
switch link set port3 down
wait_for 30 grep -q 'rank 0 has heard nothing of rank 2 on host3 for 2 s; what is done is in checkpoints' err.0 ||
    fail "rank 0 doesn't say that rank 2 is lost"
wait_for 30 grep -q 'rank 2 has heard nothing of rank 0 for 2 s' err.2 || fail "rank 2 doesn't say that rank 0 is lost"
ended() { ! pgrep -f "^$keyhole_mpi render scene.yaml" >/dev/null; }
wait_for 10 ended || fail "a rank goes on without the others"
[ ! -e a.exr ] || fail "it ended before the cable was pulled: the test needs a longer render"
# mpirun itself waits for the host to answer.
for i in 0 1 2 3; do ip netns pids "${id}n$i" | xargs -r kill -9 || true; done
{ wait $job || true; } 2>/dev/null
echo "rank 2 cut off: both sides end"

# Again, with mpirun told to look after its hosts.
switch link set port3 up
# It takes a moment until packets come through; who asks before is told that there is no way.
answers() {
    { ip netns exec "${id}n3" timeout 1 bash -c 'exec 3<>/dev/tcp/10.97.0.254/9' 2>&1 || true; } | grep -q refused
}
wait_for 30 answers || fail "host 3 doesn't come back"
export OMPI_MCA_oob_tcp_keepalive_time=2 OMPI_MCA_oob_tcp_keepalive_intvl=1 OMPI_MCA_oob_tcp_keepalive_probes=2
rm -f err.*
touch start
ranks $long -t 1 --checkpoint 0 -o a.exr --resume &
job=$!
wait_for 30 all_written || fail "no checkpoints after going on"
switch link set port1 down
if wait $job; then fail "mpirun is content without rank 0"; fi
grep -q 'lost communication with a remote daemon' log || fail "mpirun doesn't say what happened"
echo "rank 0 cut off: mpirun ends"
[ ! -e a.exr ] || fail "it ended before the cable was pulled: the test needs a longer render"
ip netns pids "${id}n1" | xargs -r kill -9 || true

"$keyhole" $long --checkpoint 1000 --resume -o a.exr
"$keyhole" $long -o b.exr
same a.exr b.exr
echo "gone on with: the same picture"
