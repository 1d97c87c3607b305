"""A Slurm cluster of this machine alone, of Debian's slurm-wlm and munge, in a folder: for the tests of the recipe.

All daemons run as the caller and listen on the loopback, with a munge key of their own: nothing of a Slurm that the
machine may have is read or changed. Jobs take the node one after the other, as the recipe's --exclusive asks.
"""

import os
import pathlib
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "sinfo")
PATH = os.pathsep.join([os.environ["PATH"], "/usr/sbin", "/sbin"])
START_SECONDS = 60

CONFIGURATION = """
ClusterName=wavecrest
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=2
JobRequeue=1
JobFileAppend=1
KillWait=20
MinJobAge=3600
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    """Ports that nobody listens on now; held together while they are chosen, so that they differ."""
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [holder.getsockname()[1] for holder in sockets]
    for holder in sockets:
        holder.close()
    return ports


class Cluster:
    """Runs from start() to stop(). submit() and facts() are sbatch and scontrol."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.daemons = []
        self.environment = {**os.environ, "PATH": PATH, "SLURM_CONF": str(self.folder / "slurm.conf")}

    def run(self, *command, check=True):
        result = subprocess.run(
            list(map(str, command)), capture_output=True, text=True, check=False, env=self.environment, cwd=self.folder,
            timeout=60,
        )  # fmt: skip
        if check and result.returncode != 0:
            raise RuntimeError(f"{command}: {result.stdout}{result.stderr}")
        return result.stdout

    def begin(self, *command):
        log = (self.folder / f"{pathlib.Path(command[0]).name}.out").open("w")
        with log:
            process = subprocess.Popen(command, stdout=log, stderr=log, env=self.environment, cwd=self.folder)
        self.daemons.append(process)

    def start(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.touch(mode=0o600)
        key.write_bytes(os.urandom(128))
        controller_port, node_port = free_ports(2)
        host = socket.gethostname().split(".")[0]
        (self.folder / "slurm.conf").write_text(
            CONFIGURATION.format(
                host=host, folder=self.folder, user=self.run("id", "-un").strip(), cpus=os.cpu_count(),
                controller_port=controller_port, node_port=node_port,
            )
        )  # fmt: skip
        self.begin(
            "munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
            f"--pid-file={self.folder}/munge.pid", f"--seed-file={self.folder}/munge.seed", "--num-threads=1",
        )  # fmt: skip
        self.wait(lambda: (self.folder / "munge.socket").exists(), START_SECONDS, "munged")
        self.begin("slurmctld", "-D")
        self.begin("slurmd", "-D", "-N", host)
        ready = lambda: self.run("sinfo", "--noheader", "--format=%t", check=False).strip() == "idle"  # noqa: E731
        self.wait(ready, START_SECONDS, "the node")

    def stop(self):
        for process in reversed(self.daemons):
            process.terminate()
        for process in reversed(self.daemons):
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def wait(self, condition, seconds, what):
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                raise RuntimeError(f"{what}: not there after {seconds} s\n{self.logs()}")
            time.sleep(0.2)

    def logs(self):
        texts = [f"--- {file.name}\n{file.read_text()[-3000:]}" for file in sorted(self.folder.glob("*.out"))]
        texts += [f"--- {file.name}\n{file.read_text()[-3000:]}" for file in sorted(self.folder.glob("*.log"))]
        return "\n".join(texts)

    def submit(self, *arguments, **variables):
        """Submits as the README does; returns the number of the job."""
        before = dict(self.environment)
        self.environment.update(variables)
        try:
            return self.run("sbatch", "--parsable", *arguments).strip()
        finally:
            self.environment = before

    def facts(self, job):
        """The key=value facts of each task of a job."""
        text = self.run("scontrol", "show", "job", job, "--oneliner")
        return [dict(word.split("=", 1) for word in line.split() if "=" in word) for line in text.splitlines() if line]

    def states(self, job):
        return [task["JobState"] for task in self.facts(job)]
