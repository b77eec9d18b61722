"""A Slurm of four nodes on this machine, for one test: everything in one folder, no service of the system touched.

Needs root (each node lives in a process namespace of its own, so that it can be killed with all that runs on it) and
Debian's slurmctld, slurmd, slurm-client and munge.
"""

import os
import pathlib
import secrets
import shutil
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo", "scancel", "unshare")


def why_not():
    """What this machine lacks to run one; nothing if it can."""
    if os.geteuid() != 0:
        return "a Slurm of its own needs root"
    missing = [program for program in PROGRAMS if shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin") is None]
    return f"not installed: {', '.join(missing)} (Debian: slurmctld slurmd slurm-client munge)" if missing else ""


def free_ports(count):
    """Consecutive ports that nobody listens on now."""
    for first in range(20000, 32000, count):
        sockets = [socket.socket() for _ in range(count)]
        try:
            for offset, one in enumerate(sockets):
                one.bind(("127.0.0.1", first + offset))
            return first
        except OSError:
            continue
        finally:
            for one in sockets:
                one.close()
    raise RuntimeError("no free ports")


# Short waits: a node counts as dead after some seconds, and a task of it may start again as soon.
CONFIG = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
SlurmctldPort={port}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
SlurmdTimeout=5
MessageTimeout=3
KillWait=2
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmdParameters=config_overrides
NodeName=n[1-{nodes}] NodeHostname=localhost NodeAddr=127.0.0.1 Port={first_node_port}-{last_node_port} CPUs={processors} RealMemory=1000
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class SlurmCluster:
    def __init__(self, folder, nodes=4, processors=1):
        self.folder = pathlib.Path(folder)
        self.processes = {}
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"),
                                PATH=os.environ["PATH"] + ":/usr/sbin")
        self.folder.mkdir(mode=0o700, exist_ok=True)
        (self.folder / "state").mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o400)
        port = free_ports(nodes + 1)
        (self.folder / "slurm.conf").write_text(CONFIG.format(
            host=socket.gethostname().split(".")[0], folder=self.folder, port=port, nodes=nodes, processors=processors,
            first_node_port=port + 1, last_node_port=port + nodes))
        self.start("munged", "munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                   f"--pid-file={self.folder}/munge.pid", f"--seed-file={self.folder}/munge.seed",
                   f"--log-file={self.folder}/munge.log")
        self.wait("munged", lambda: (self.folder / "munge.socket").exists())
        self.start("slurmctld", "slurmctld", "-D", "-i", "-f", self.folder / "slurm.conf")
        for number in range(1, nodes + 1):
            (self.folder / f"spool-n{number}").mkdir()
            self.start_node(f"n{number}")
        self.wait("all nodes idle", lambda: self.slurm("sinfo", "-h", "-N", "-t", "idle", "-o", "%N").split() ==
                  [f"n{number}" for number in range(1, nodes + 1)])

    def start(self, name, *words):
        with open(self.folder / f"{name}.out", "wb") as output:
            self.processes[name] = subprocess.Popen([str(word) for word in words], stdin=subprocess.DEVNULL, stdout=output,
                                                    stderr=output, env=self.environment)

    def start_node(self, name):
        """The shell is the namespace's first process; with it goes everything in there."""
        self.start(name, "unshare", "--pid", "--fork", "--kill-child=KILL", "--mount-proc", "sh", "-c",
                   'slurmd -D -N "$0" -f "$1" & wait', name, self.folder / "slurm.conf")

    def kill_node(self, name):
        """As if its power cord were pulled."""
        self.processes[name].kill()
        self.processes.pop(name).wait()

    def slurm(self, *words):
        return subprocess.run([str(word) for word in words], capture_output=True, text=True, env=self.environment).stdout

    def wait(self, what, condition, seconds=240):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                logs = "\n".join(f"{path.name}:\n{path.read_text(errors='replace')[-2000:]}"
                                 for path in sorted(self.folder.glob("*.[lo][ou][gt]")))
                raise TimeoutError(f"waited {seconds} s for: {what}\n{self.slurm('squeue')}\n{logs}")
            time.sleep(0.1)

    def stop(self):
        for job in self.slurm("squeue", "-h", "-o", "%F").split():
            self.slurm("scancel", job)
        for name in [name for name in self.processes if name not in ("munged", "slurmctld")]:
            self.kill_node(name)
        for name in ("slurmctld", "munged"):
            if name in self.processes:
                self.processes[name].terminate()
                self.processes[name].wait()
