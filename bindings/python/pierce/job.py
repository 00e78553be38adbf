# SPDX-License-Identifier: Apache-2.0
"""Jobs of `pierce job` on anything that has the interface of concurrent.futures.

A job is a folder that `pierce job create` made: a scene, a query, rays in chunks. Its chunks are
cast by the workers of an executor: threads, processes, `dask.distributed.Client.get_executor()`,
`mpi4py.futures.MPIPoolExecutor`. Each chunk is the command's own work, in a process of its own,
which maps the scene's file; so what a worker holds is shared, and a worker that dies costs a chunk.
"""

from __future__ import annotations

import json
import os
import subprocess
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable

from .__main__ import tool
from ._errors import BadFile


@dataclass
class Status:
    """How far a job has come: `done` of its `chunks` are there, of all its `rays`."""

    rays: int
    chunks: int
    done: int

    @property
    def complete(self) -> bool:
        """Whether all chunks are there."""
        return self.done == self.chunks


def tool_path() -> Path:
    """Where the command's program lies in this package; a package can be built without it."""
    return Path(tool())


def create(folder: str | os.PathLike[str], *arguments: str | os.PathLike[str]) -> None:
    """Makes a job's folder.

    Args:
        folder: where.
        arguments: the meshes or the scene file, the rays and the query, as the command has them:
            `pierce job create --help`.

    Raises BadFile, or ValueError for arguments that it does not know, with the command's line.

    >>> import os, tempfile
    >>> mesh = pierce.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> with tempfile.TemporaryDirectory() as there:
    ...     mesh.save(os.path.join(there, "one.pierce"))
    ...     create(os.path.join(there, "job"), os.path.join(there, "one.pierce"),
    ...            "--sphere", "1000", "--reduce", "triangles")
    ...     status(os.path.join(there, "job"))
    Status(rays=1000, chunks=1, done=0)
    """
    _command("create", *arguments, "--job", folder, "--quiet")


def status(folder: str | os.PathLike[str]) -> Status:
    """How far the job in this folder has come. Raises BadFile if there is none."""
    told = json.loads(_command("status", folder, "--json"))
    return Status(told["rays"], told["chunks"], told["done"])


def run(folder: str | os.PathLike[str], executor: Executor, *, threads: int = 1,
        progress: Callable[[float], Any] | None = None) -> Status:
    """Casts the chunks of a job that are not there yet, on the workers of an executor.

    Args:
        folder: the job's, which all workers see under this name.
        executor: of concurrent.futures or with its interface.
        threads: how many each chunk takes on its worker; 0: as many as the worker's machine has.
        progress: a function of the fraction done.

    Ends when all chunks are there. If a chunk fails, or its worker dies, the others go on, and then
    the first failure is raised; what is there stays, so running it again goes on from there. Each
    chunk costs some 10 ms beside its rays: make chunks of seconds.
    """
    told = status(folder)
    path = os.path.abspath(os.fspath(folder))
    futures = {executor.submit(_cast, path, chunk, told.chunks, threads): chunk
               for chunk in range(told.chunks) if not os.path.exists(_chunk_file(path, chunk))}
    failure: BaseException | None = None
    for number, future in enumerate(as_completed(futures), 1):
        try:
            future.result()
        except Exception as error:
            failure = failure or error
        if progress is not None:
            progress(number / len(futures))
    if failure is not None:
        raise failure
    return status(folder)


def merge(folder: str | os.PathLike[str], out: str | os.PathLike[str]) -> None:
    """Writes the answers of all chunks to one .npy file: the bytes that `pierce cast` would have
    written. Raises BadFile if a chunk is missing or damaged."""
    _command("merge", folder, "--out", out, "--quiet")


def verify(folder: str | os.PathLike[str], chunks: int = 10) -> None:
    """Casts so many of the chunks anew, chosen at random, and compares the bytes. Raises BadFile
    if one differs."""
    _command("verify", folder, "--chunks", str(chunks), "--quiet")


def _chunk_file(folder: str, chunk: int) -> str:
    return os.path.join(folder, "chunks", f"{chunk:09}.npy")


def _cast(folder: str, chunk: int, chunks: int, threads: int) -> None:
    _command("run", folder, "--part", f"{chunk}/{chunks}", "--threads", str(threads), "--quiet")


def _command(*arguments: str | os.PathLike[str]) -> str:
    words: list[str] = [os.fspath(argument) for argument in arguments]
    done = subprocess.run([tool(), "job", *words], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, encoding="utf-8", check=False)
    if done.returncode == 0:
        return str(done.stdout)
    said = str(done.stderr).strip().removeprefix("pierce: ") or f"ended with {done.returncode}"
    raise ValueError(said) if done.returncode == 2 else BadFile(said)
