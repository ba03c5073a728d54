#!/bin/sh
# A real Slurm array on this machine: two shards of a batch give the bytes that one run gives. Skipped (77) where Slurm is
# not installed or this is not root, whom its daemons need to run jobs without accounts.
# usage: slurm_array_test.sh MIEN SOURCE_FOLDER
set -eu
mien=$1
source_folder=$2
for program in slurmctld slurmd sbatch sinfo; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not installed"; exit 77; }
done
[ "$(id -u)" = 0 ] || { echo "skipped: not root"; exit 77; }

work=$(mktemp -d)
stop() {
  for file in "$work/slurmd.pid" "$work/slurmctld.pid"; do
    [ -f "$file" ] || continue
    pid=$(cat "$file")
    kill "$pid" 2>/dev/null || continue
    waited=0
    while kill -0 "$pid" 2>/dev/null && [ "$waited" -lt 40 ]; do sleep 0.25; waited=$((waited + 1)); done
  done
  rm -rf "$work"
}
trap stop EXIT INT TERM
host=$(hostname -s)
mkdir "$work/state" "$work/spool"
cat > "$work/slurm.conf" <<CONF
ClusterName=mien
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
ReturnToService=2
SlurmUser=root
SlurmdUser=root
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
SLURM_CONF=$work/slurm.conf
export SLURM_CONF
slurmctld -c && slurmd -c || { echo "skipped: Slurm's daemons do not start here"; exit 77; }
tries=0
until sinfo --noheader --format=%T 2>/dev/null | grep -q idle; do
  tries=$((tries + 1))
  [ "$tries" -lt 60 ] || { echo "skipped: the node does not become idle"; exit 77; }
  sleep 0.5
done

for name in human cartoon creature; do "$mien" sample "$name" -o "$work" --quiet; done
jobs='{"source": "human.glb", "target": "cartoon.glb", "output": "OUT/cartoon.glb"},
      {"source": "human.glb", "target": "creature.glb", "output": "OUT/creature.glb"}'
echo "{\"jobs\": [$jobs]}" | sed 's/OUT/alone/' > "$work/alone.json"
echo "{\"jobs\": [$jobs]}" | sed 's/OUT/farm/' > "$work/farm.json"
"$mien" batch "$work/alone.json" --quiet
MIEN=$mien sbatch --wait --array=1-2 --output="$work/task.%a.log" "$source_folder/docs/farm/slurm.sh" "$work/farm.json" ||
  { cat "$work"/task.*.log; exit 1; }
for name in cartoon creature; do
  cmp "$work/alone/$name.glb" "$work/farm/$name.glb"
done
[ -f "$work/farm.1.report.json" ] && [ -f "$work/farm.2.report.json" ]
echo "two tasks, the same bytes"
