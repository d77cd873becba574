#!/bin/bash
# one_node_slurm.sh FOLDER COMMAND...: runs COMMAND with a Slurm cluster of this machine alone, on loopback, in
# FOLDER. Exit code 77: Slurm is not installed or does not start here; else that of COMMAND.
set -u
folder=$1; shift
unavailable() { echo "no Slurm: $1"; exit 77; }
for program in munged slurmctld slurmd sbatch sinfo; do
  command -v $program >/dev/null || PATH=$PATH:/usr/sbin command -v $program >/dev/null || unavailable "$program is not installed"
done
PATH=$PATH:/usr/sbin
[ "$(id -u)" -eq 0 ] || unavailable "its daemons must be started as root"

mkdir -p "$folder"/{munge,state,spool,log}
chmod 711 "$folder/munge"
dd if=/dev/urandom of="$folder/munge/munge.key" bs=1 count=1024 status=none
chmod 400 "$folder/munge/munge.key"
stop() { kill $(cat "$folder"/slurmd.pid "$folder"/slurmctld.pid "$folder"/munge/munged.pid 2>/dev/null) 2>/dev/null; }
trap stop EXIT
munged --force --key-file="$folder/munge/munge.key" --socket="$folder/munge/munge.sock" \
  --pid-file="$folder/munge/munged.pid" --log-file="$folder/munge/munged.log" \
  --seed-file="$folder/munge/munged.seed" --num-threads=1 2>/dev/null || unavailable "munged does not start"

host=$(hostname -s)
memory=$(($(slurmd -C | sed -n 's/.*RealMemory=\([0-9]*\).*/\1/p') - 512))
port=$((20000 + $$ % 20000))
cat >"$folder/slurm.conf" <<CONF
ClusterName=liana
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/munge.sock
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/linux
AccountingStorageType=accounting_storage/none
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=2,bf_interval=2
CompleteWait=0
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
MpiDefault=none
ReturnToService=2
MailProg=/bin/true
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$memory State=UNKNOWN
PartitionName=bake Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$folder/slurm.conf
slurmctld 2>/dev/null || unavailable "slurmctld does not start"
slurmd 2>/dev/null || unavailable "slurmd does not start"
for _ in $(seq 300); do
  sinfo -h -o %t 2>/dev/null | grep -q idle && ready=yes && break
  sleep 0.1
done
[ "${ready:-}" ] || unavailable "the node does not become ready: $(tail -1 "$folder/log/slurmctld.log")"
"$@"
