"""Debian's Grid Engine on hosts of its own: a master at the head, one slot on each node, everything in one folder."""

import os
import pathlib
import subprocess

from hosts import Hosts, missing

PROGRAMS = pathlib.Path("/usr/lib/gridengine")
SHARED = pathlib.Path("/usr/share/gridengine")


def why_not():
    if reason := missing(()):
        return reason
    absent = [name for name in ("sge_qmaster", "sge_execd", "qsub") if not (PROGRAMS / name).exists()]
    return f"not installed: {', '.join(absent)} (Debian: gridengine-master gridengine-exec gridengine-client)" if absent else ""


BOOTSTRAP = """\
admin_user none
default_domain none
ignore_fqdn false
spooling_method classic
spooling_lib libspoolc
spooling_params {cell};{spool}/master
binary_path {programs}
qmaster_spool_dir {spool}/master
security_mode none
listener_threads 2
worker_threads 2
scheduler_threads 1
"""

# A node that is not heard of for ten seconds is unknown, and five seconds later its jobs are started again.
CHANGED = {"min_uid": "0", "min_gid": "0", "mailer": "/bin/true", "load_report_time": "00:00:03", "max_unheard": "00:00:10",
           "reschedule_unknown": "00:00:05"}

QUEUE = """\
qname main
hostlist @nodes
qtype BATCH
rerun TRUE
slots 1
shell /bin/sh
shell_start_mode posix_compliant
tmpdir /tmp
"""
# What qconf wants to be told although nothing is wanted.
NOTHING = {"NONE": "load_thresholds suspend_thresholds ckpt_list pe_list prolog epilog starter_method suspend_method resume_method "
                   "terminate_method owner_list user_lists xuser_lists subordinate_list complex_values projects xprojects calendar",
           "INFINITY": "s_rt h_rt s_cpu h_cpu s_fsize h_fsize s_data h_data s_stack h_stack s_core h_core s_rss h_rss s_vmem h_vmem",
           "0": "seq_no priority", "1": "nsuspend", "00:05:00": "suspend_interval min_cpu_interval", "UNDEFINED": "processors",
           "00:00:60": "notify", "default": "initial_state"}


class GridEngine(Hosts):
    def __init__(self, folder, nodes=4):
        super().__init__(folder, nodes)
        root, spool = self.folder / "root", self.folder / "spool"
        cell = root / "default/common"
        cell.mkdir(parents=True)
        (spool / "master").mkdir(parents=True)
        for name in ("bin", "lib", "utilbin"):
            (root / name).symlink_to(pathlib.Path("/var/lib/gridengine") / name)
        (root / "util").symlink_to(SHARED / "util")
        (cell / "bootstrap").write_text(BOOTSTRAP.format(cell=cell, spool=spool, programs=PROGRAMS))
        (cell / "act_qmaster").write_text("head\n")
        (cell / "cluster_name").write_text("test\n")
        self.environment = dict(os.environ, SGE_ROOT=str(root), SGE_CELL="default", SGE_QMASTER_PORT="6444", SGE_EXECD_PORT="6445",
                                SGE_ARCH="lx-amd64", SGE_ND="1", LD_LIBRARY_PATH=str(PROGRAMS))
        changed = {**CHANGED, "execd_spool_dir": str(spool)}
        lines = (SHARED / "default-configuration").read_text().splitlines()
        self.write("configuration", "".join(f"{line.split()[0]} {changed[line.split()[0]]}\n" if line.split()[:1] and line.split()[0] in changed
                                            else line + "\n" for line in lines))
        self.run("spoolinit", "classic", "libspoolc", f"{cell};{spool}/master", "init")
        for what, value in (("configuration", self.folder / "configuration"), ("complexes", SHARED / "util/resources/centry"),
                            ("usersets", SHARED / "util/resources/usersets"), ("managers", "root")):
            self.run("spooldefaults", what, value)
        self.start("head", "master", PROGRAMS / "sge_qmaster", environment=self.environment)
        self.wait("the master", lambda: self.run("qconf", "-sh", fails=True).returncode == 0)
        usual = self.run("qconf", "-ssconf").stdout
        self.run("qconf", "-Msconf", self.write("scheduling", usual.replace("0:0:15", "0:0:1").replace("flush_submit_sec                  0", "flush_submit_sec 1")
                                                .replace("flush_finish_sec                  0", "flush_finish_sec 1")))
        for node in self.nodes:
            self.run("qconf", "-ah", node)
        self.run("qconf", "-as", "head")
        for node in self.nodes:
            self.start(node, "node", PROGRAMS / "sge_execd", environment=self.environment)
        self.run("qconf", "-Ahgrp", self.write("group", "group_name @nodes\nhostlist " + " ".join(self.nodes) + "\n"))
        self.run("qconf", "-Aq", self.write("queue", QUEUE + "".join(
            f"{name} {value}\n" for value, names in NOTHING.items() for name in names.split())))
        self.wait("all nodes", lambda: self.run("qstat", "-f").stdout.count("lx-amd64      \n") == nodes)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def run(self, program, *words, fails=False):
        done = subprocess.run(self.on("head", PROGRAMS / program, *words), env=self.environment, capture_output=True, text=True)
        if done.returncode != 0 and not fails:
            raise RuntimeError(f"{program} {' '.join(map(str, words))}: {done.stdout}{done.stderr}")
        return done
