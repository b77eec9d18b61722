"""OpenSSH servers on hosts of their own, and an `ssh` that knows only them."""

import os
import pathlib
import shutil
import subprocess

from hosts import Hosts, missing


def why_not():
    return missing(("sshd", "ssh", "ssh-keygen"))


SERVER = """\
ListenAddress {address}
HostKey {folder}/host_key
AuthorizedKeysFile {folder}/key.pub
PidFile none
StrictModes no
UsePAM no
PermitRootLogin prohibit-password
PasswordAuthentication no
{more}
"""
CLIENT = """\
Host *
    IdentityFile {folder}/key
    IdentitiesOnly yes
    UserKnownHostsFile /dev/null
    StrictHostKeyChecking no
    LogLevel ERROR
"""


class SecureShell(Hosts):
    def __init__(self, folder, nodes=4, more=None):
        """`more`: lines of a node's server, by its name."""
        super().__init__(folder, nodes)
        pathlib.Path("/run/sshd").mkdir(mode=0o755, exist_ok=True)
        for name in ("host_key", "key"):
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", self.folder / name], check=True)
        (self.folder / "client").write_text(CLIENT.format(folder=self.folder))
        (self.folder / "bin").mkdir()
        program = self.folder / "bin/ssh"
        program.write_text(f'#!/bin/sh\nexec {shutil.which("ssh")} -F {self.folder}/client "$@"\n')
        program.chmod(0o755)
        self.environment = dict(os.environ, PATH=f"{self.folder}/bin:{os.environ['PATH']}")
        for node in self.nodes:
            config = self.folder / f"server-{node}"
            config.write_text(SERVER.format(address=self.address(node), folder=self.folder, more=(more or {}).get(node, "")))
            self.start(node, "server", shutil.which("sshd", path=os.environ["PATH"] + ":/usr/sbin"), "-D", "-e", "-f", config)
        for node in self.nodes:
            self.wait(f"ssh to {node}", lambda: self.ask(node, "hostname").stdout.strip() == node)

    def ask(self, node, command):
        return subprocess.run(self.on("head", "ssh", node, command), env=self.environment, capture_output=True, text=True)
