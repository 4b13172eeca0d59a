#!/bin/sh
# A Slurm of its own on this machine, for a trial without a cluster: slurm-loopback.sh STUDY.toml FOLDER [SHARDS]. Needs root and the packages slurmctld,
# slurmd and munge; stops what it has started, by the numbers of its own processes.
set -eu
study=$1 folder=$2 shards=${3:-24}
here=$(cd "$(dirname "$0")" && pwd)
state=$(mktemp -d)
host=$(hostname -s)
threads=$(nproc)
started=
stop() {
    # The last that was started is the first to stop.
    for number in $started; do kill "$number" 2>/dev/null || true; done
    for number in $started; do while kill -0 "$number" 2>/dev/null; do sleep 0.1; done; done
    rm -rf "$state"
}
trap stop EXIT INT TERM
# A key, a socket and a daemon of this trial's own.
dd if=/dev/urandom of="$state/munge.key" bs=1024 count=1 2>/dev/null
chmod 700 "$state" && chmod 400 "$state/munge.key"
munged --foreground --force --key-file="$state/munge.key" --socket="$state/munge.socket" --pid-file="$state/munge.pid" \
    --log-file="$state/munge.log" --seed-file="$state/munge.seed" --num-threads=2 >"$state/munged.out" 2>&1 &
started="$! $started"
cat >"$state/slurm.conf" <<END
ClusterName=trial
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
AuthType=auth/munge
AuthInfo=socket=$state/munge.socket
CredType=cred/munge
SlurmUser=root
StateSaveLocation=$state/ctld
SlurmdSpoolDir=$state/slurmd
SlurmctldPidFile=$state/slurmctld.pid
SlurmdPidFile=$state/slurmd.pid
SlurmctldLogFile=$state/slurmctld.log
SlurmdLogFile=$state/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
MaxArraySize=10001
NodeName=$host NodeAddr=127.0.0.1 CPUs=$threads State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
mkdir -p "$state/ctld" "$state/slurmd"
export SLURM_CONF="$state/slurm.conf"
sleep 1
slurmctld -D -f "$SLURM_CONF" >"$state/slurmctld.out" 2>&1 &
started="$! $started"
slurmd -D -f "$SLURM_CONF" >"$state/slurmd.out" 2>&1 &
started="$! $started"
for _ in $(seq 100); do
    sinfo -h -o %T 2>/dev/null | grep -q idle && break
    sleep 0.2
done
sinfo
"$here/slurm.sh" "$study" "$folder" "$shards"
while [ -n "$(squeue -h)" ]; do sleep 0.5; done
cat "$folder/merge.log"
