"""Hosts for one test: network namespaces on this machine, a head and some nodes, joined by a bridge that nothing else is on.

Each host has a name and an address of its own. A node's programs live in a process namespace, so that the node can be killed
with all that runs on it. Needs root."""

import os
import pathlib
import shutil
import subprocess
import time

ADDRESSES = "10.77.0"


def missing(programs):
    """Why a test cannot run here; nothing if it can."""
    if os.geteuid() != 0:
        return "hosts of its own need root"
    search = os.environ["PATH"] + ":/usr/sbin:/sbin"
    absent = [name for name in ("ip", "unshare", *programs) if shutil.which(name, path=search) is None]
    if absent:
        return f"not installed: {', '.join(absent)}"
    tried = subprocess.run(["unshare", "--net", "--uts", "--pid", "--fork", "--mount-proc", "true"], capture_output=True)
    return "" if tried.returncode == 0 else "this machine allows no namespaces"


class Hosts:
    def __init__(self, folder, nodes=4):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(exist_ok=True)
        self.nodes = [f"node{number}" for number in range(1, nodes + 1)]
        self.names = ["head", *self.nodes]
        self.processes = {}
        table = "127.0.0.1 localhost\n" + "".join(f"{self.address(name)} {name}\n" for name in self.names)
        for name in self.names:
            self.ip("netns", "add", self.space(name))
            private = self.files(name)
            private.mkdir(parents=True)
            (private / "hosts").write_text(table)
            self.ip("-n", self.space(name), "link", "set", "lo", "up")
        head = self.space("head")
        self.ip("-n", head, "link", "add", "bridge0", "type", "bridge")
        self.ip("-n", head, "addr", "add", f"{self.address('head')}/24", "dev", "bridge0")
        self.ip("-n", head, "link", "set", "bridge0", "up")
        for name in self.nodes:
            self.ip("-n", head, "link", "add", f"to-{name}", "type", "veth", "peer", "name", "eth0", "netns", self.space(name))
            self.ip("-n", head, "link", "set", f"to-{name}", "master", "bridge0", "up")
            self.ip("-n", self.space(name), "addr", "add", f"{self.address(name)}/24", "dev", "eth0")
            self.ip("-n", self.space(name), "link", "set", "eth0", "up")

    @staticmethod
    def ip(*words):
        subprocess.run(["ip", *words], check=True, capture_output=True)

    @staticmethod
    def space(name):
        return f"capstan{os.getpid()}-{name}"

    def files(self, name):
        """What `ip netns exec` lays over /etc."""
        return pathlib.Path("/etc/netns") / self.space(name)

    def address(self, name):
        return f"{ADDRESSES}.{self.names.index(name) + 1}"

    def on(self, name, *words):
        """The call that runs `words` on that host."""
        return ["ip", "netns", "exec", self.space(name), "unshare", "--uts", "sh", "-c", 'hostname "$0"; exec "$@"', name,
                *map(str, words)]

    def start(self, name, title, *words, environment=None):
        """A program that stays. On a node its shell is the first process of a namespace; with it goes everything in there."""
        call = self.on(name, *words)
        if name != "head":
            call = self.on(name, "unshare", "--pid", "--fork", "--kill-child=KILL", "--mount-proc", "sh", "-c", '"$@" & wait', "sh",
                           *words)
        with open(self.folder / f"{title}-{name}.out", "wb") as output:
            self.processes.setdefault(name, []).append(
                subprocess.Popen(call, stdin=subprocess.DEVNULL, stdout=output, stderr=output, env=environment,
                                 start_new_session=True))

    def kill(self, name):
        """As if its power cord were pulled."""
        for process in self.processes.pop(name, []):
            process.kill()
            process.wait()

    def wait(self, what, condition, seconds=240):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                said = "\n".join(f"{path.name}:\n{path.read_text(errors='replace')[-1000:]}" for path in sorted(self.folder.glob("*.out")))
                raise TimeoutError(f"waited {seconds} s for: {what}\n{said}")
            time.sleep(0.2)

    def stop(self):
        for name in list(self.processes):
            self.kill(name)
        for name in self.names:
            subprocess.run(["ip", "netns", "del", self.space(name)], capture_output=True)
            shutil.rmtree(self.files(name), ignore_errors=True)
