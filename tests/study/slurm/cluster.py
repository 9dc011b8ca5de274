"""A cluster of Slurm with one node, this machine, as long as a with-statement lasts.

Its limit of memory works without cgroups, which containers may not have: once a second, slurmd adds up what the
processes of a job have, and kills those of one that has more than it asked for."""
import os
import shutil
import socket
import subprocess
import time
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo")
LARGEST_ARRAY = 4

CONFIGURATION = """\
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
JobAcctGatherParams=OverMemoryKill
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=sched_min_interval=0,batch_sched_delay=0
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=1
MaxArraySize={largest_array}
NodeName=localhost NodeAddr=127.0.0.1 CPUs=2 RealMemory=8192 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES DefMemPerNode=2048 State=UP
"""


def missing_programs():
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"  # where Debian has the daemons
    return [name for name in PROGRAMS if not shutil.which(name, path=path)]


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Cluster:
    """Sets SLURM_CONF; daemons die with this process, however it ends."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.daemons = []

    def __enter__(self):
        os.environ["PATH"] += ":/usr/sbin:/sbin"
        os.environ["SLURM_CONF"] = str(self.folder / "slurm.conf")
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True)
        self.folder.chmod(0o755)
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        user = subprocess.run(["id", "-un"], check=True, capture_output=True, text=True).stdout.strip()
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            folder=self.folder, user=user, controller_port=free_port(), node_port=free_port(),
            largest_array=LARGEST_ARRAY))
        try:
            self.start("munged", "--foreground", "--force", f"--key-file={key}",
                       *(f"--{name}={self.folder}/munge.{ending}" for name, ending in
                         (("socket", "socket"), ("pid-file", "pid"), ("log-file", "log"), ("seed-file", "seed"))))
            self.start("slurmctld", "-D")
            self.start("slurmd", "-D", "-N", "localhost")
            self.wait_for(lambda: "idle" in command("sinfo", "--noheader").stdout)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        command("scancel", f"--user={os.getuid()}")
        try:
            self.wait_for(lambda: not command("squeue", "--noheader").stdout, seconds=10)
        except TimeoutError:
            pass  # it does not answer; its daemons end all the same
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(timeout=5)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def start(self, name, *arguments):
        with open(self.folder / f"{name}.out", "w", encoding="utf-8") as output:
            self.daemons.append(subprocess.Popen(
                ["setpriv", "--pdeathsig=KILL", "--", name, *arguments],
                stdout=output, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL))

    def wait_for(self, condition, seconds=30):
        """What it gives once that is true."""
        end = time.monotonic() + seconds
        while not (result := condition()):
            if time.monotonic() > end:
                raise TimeoutError("".join(
                    f"== {file.name}\n{file.read_text(errors='replace')}" for file in self.folder.glob("*.out")))
            time.sleep(0.05)
        return result


def command(*words):
    return subprocess.run(words, capture_output=True, text=True, check=False)
