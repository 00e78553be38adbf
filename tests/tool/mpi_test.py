#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Jobs under mpirun: four ranks, one of them killed; two hosts, which are network namespaces.

Debian's openmpi-bin has what is needed; without it the tests are skipped.
"""

import os
import shutil
import signal
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np

from harness import PATIENCE, TOOL, ToolTest

MPIRUN = shutil.which("mpirun")
HOSTS = {f"pierce-{os.getpid()}-a": "10.99.0.1", f"pierce-{os.getpid()}-b": "10.99.0.2"}
# Chunks of a job that no four ranks end before one of them is killed.
CHUNKS, CHUNK = 400, 4000

CLEAN = {name: value for name, value in os.environ.items()
         if not name.startswith(("OMPI_", "PMI_", "PMIX_", "SLURM_"))}


def ip(*words):
    return subprocess.run(["ip", *words], capture_output=True, text=True, check=False)


@unittest.skipUnless(MPIRUN, "there is no mpirun here: apt-get install openmpi-bin")
class MpiTest(ToolTest):
    def setUp(self):
        super().setUp()
        random = np.random.default_rng(1)
        corners = random.uniform(-1, 1, (300, 1, 3)) + random.uniform(-0.2, 0.2, (300, 3, 3))
        self.write_ply("a.ply", corners.reshape(-1, 3), np.arange(900).reshape(-1, 3))
        self.rays = ["--sphere", str(CHUNKS * CHUNK), "--query", "any"]
        self.succeed("job", "create", "a.ply", *self.rays, "--chunk", CHUNK, "--job", "job",
                     "--quiet")

    def mpirun(self, *options, prefix=()):
        process = subprocess.Popen(
            [*prefix, MPIRUN, "--allow-run-as-root", "--oversubscribe", *options, "-n", "4", TOOL,
             "job", "run", "job", "--threads", "1"], cwd=self.dir, stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=CLEAN)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def chunks(self):
        return len(list((self.dir / "job" / "chunks").glob("*[0-9].npy")))

    def ranks(self):
        """{process: rank} of those that run this test's job."""
        found = {}
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                if os.readlink(folder / "cwd") != str(self.dir.resolve()) or \
                        not (folder / "exe").samefile(TOOL):
                    continue
                variables = (folder / "environ").read_bytes().split(b"\0")
            except OSError:  # it has ended
                continue
            for variable in variables:
                name, _, value = variable.partition(b"=")
                if name == b"OMPI_COMM_WORLD_RANK":
                    found[int(folder.name)] = int(value)
        return found

    def kill_one_and_resume(self, start, hosts=1):
        process = start()
        deadline = time.monotonic() + PATIENCE
        while self.chunks() < 8 and time.monotonic() < deadline:
            time.sleep(0.005)
        ranks = self.ranks()
        networks = {os.readlink(f"/proc/{pid}/ns/net") for pid in ranks}
        self.assertEqual(len(networks), hosts)
        victims = [pid for pid, rank in ranks.items() if rank == 3]
        self.assertEqual(len(victims), 1)
        os.kill(victims[0], signal.SIGKILL)
        process.communicate(timeout=PATIENCE)
        self.assertNotEqual(process.returncode, 0)
        self.assertTrue(8 <= self.chunks() < CHUNKS, self.chunks())
        process = start()
        said, _ = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 0, said)
        for rank in range(4):
            self.assertIn(f"{rank} of 4", said)
        self.succeed("job", "merge", "job", "--out", "merged.npy", "--quiet")
        self.succeed("cast", "a.ply", *self.rays, "--out", "cast.npy", "--quiet")
        self.assertEqual((self.dir / "merged.npy").read_bytes(),
                         (self.dir / "cast.npy").read_bytes())

    def test_a_rank_is_killed(self):
        self.kill_one_and_resume(self.mpirun)

    def test_two_hosts(self):
        for host in HOSTS:
            if ip("netns", "add", host).returncode != 0:
                self.skipTest("no network namespaces can be made here (root, iproute2)")
            self.addCleanup(ip, "netns", "del", host)
        first, second = HOSTS
        wires = ip("link", "add", "wire", "netns", first, "type", "veth", "peer", "name", "wire",
                   "netns", second)
        if wires.returncode != 0:
            self.skipTest(f"no veth: {wires.stderr.strip()}")
        for host, address in HOSTS.items():
            for words in (("addr", "add", f"{address}/24", "dev", "wire"),
                          ("link", "set", "wire", "up"), ("link", "set", "lo", "up")):
                self.assertEqual(ip("-n", host, *words).returncode, 0)
        # What stands for ssh: mpirun calls it with an address and a command.
        agent = self.dir / "agent"
        cases = "".join(f"{address}) host={host};; " for host, address in HOSTS.items())
        agent.write_text(f'#!/bin/sh\ncase $1 in {cases}esac\nshift\n'
                         'exec ip netns exec "$host" sh -c "$*"\n')
        agent.chmod(0o755)
        self.kill_one_and_resume(lambda: self.mpirun(
            "--mca", "plm_rsh_agent", str(agent), "--host",
            ",".join(f"{address}:2" for address in HOSTS.values()),
            prefix=("ip", "netns", "exec", first)), hosts=2)


if __name__ == "__main__":
    unittest.main()
