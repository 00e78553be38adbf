#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Where Dask's scheduler ends: simulated workers that cast nothing, and tasks that only wait.

The workers are objects in a few processes, the scheduler has a process of its own, and a task is a
coroutine that sleeps: so the scheduler's work is the real one and the workers' is little. For each
number of workers, tasks that end at once and tasks that would be 500 a second: how many a second
came about, the scheduler's processor time a task, whose inverse is its limit on a free core, and a
second with nothing to do (heartbeats), and the memory of the scheduler and of a worker.

usage: dask_scheduler.py [--workers N ...] [--tasks N] [--processes N]
"""

import argparse
import asyncio
import multiprocessing
import os
import resource
import time

os.environ.setdefault("DASK_DISTRIBUTED__LOGGING__DISTRIBUTED", "critical")  # children, too

from distributed import Client, Scheduler, Worker


async def nap(number, seconds):
    """A task: no thread, no processor."""
    await asyncio.sleep(seconds)
    return number


def memory():
    """Of this process, in MiB: the most that it ever had."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def some_workers(address, count, ready, end, used):
    async def live():
        before = memory()
        workers = [Worker(address, nthreads=1, memory_limit=0, dashboard=False,
                          heartbeat_interval="10s") for _ in range(count)]
        for first in range(0, count, 50):
            await asyncio.gather(*workers[first:first + 50])
        used.put((memory() - before) / max(count, 1))
        ready.release()
        while not end.is_set():
            await asyncio.sleep(0.5)
        await asyncio.gather(*(worker.close(nanny=False) for worker in workers))
    asyncio.run(live())


def scheduler(address, end, processor_time, used):
    async def live():
        async with Scheduler(port=0, dashboard=False, host="127.0.0.1") as made:
            address.put(made.address)
            while not end.is_set():
                processor_time.value = time.process_time()
                used.value = memory()
                await asyncio.sleep(0.05)
    asyncio.run(live())


class Measurement:
    """So many workers and a scheduler, and what tasks cost it."""

    def __init__(self, workers, processes):
        context = multiprocessing.get_context("spawn")
        self.end, ready = context.Event(), context.Semaphore(0)
        address, used = context.Queue(), context.Queue()
        self.processor_time = context.Value("d", 0.0)
        self.memory = context.Value("d", 0.0)
        self.started = [context.Process(
            target=scheduler, args=(address, self.end, self.processor_time, self.memory))]
        self.started[0].start()
        where = address.get()
        processes = min(processes, workers)
        for part in range(processes):
            count = workers // processes + (part < workers % processes)
            self.started.append(context.Process(
                target=some_workers, args=(where, count, ready, self.end, used)))
            self.started[-1].start()
        for _ in range(processes):
            ready.acquire()
        self.memory_of_worker = max(used.get() for _ in range(processes))
        self.client = Client(where)
        self.client.wait_for_workers(workers)
        self.gather(workers, 0)

    def gather(self, tasks, seconds):
        self.client.gather(self.client.map(nap, range(tasks), seconds=seconds, pure=False))

    def idle(self, seconds=10):
        """Scheduler's processor time a second in which nobody asks for anything."""
        begin, before = time.perf_counter(), self.processor_time.value
        time.sleep(seconds)
        return (self.processor_time.value - before) / (time.perf_counter() - begin)

    def tasks(self, tasks, seconds):
        """(tasks a second, scheduler's processor seconds a task)."""
        begin, before = time.perf_counter(), self.processor_time.value
        self.gather(tasks, seconds)
        wall = time.perf_counter() - begin
        time.sleep(0.2)
        return tasks / wall, (self.processor_time.value - before) / tasks

    def close(self):
        self.client.close()
        self.end.set()
        for process in self.started:
            process.join(60)
            process.kill()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--workers", type=int, nargs="+", default=[10, 100, 300, 1000])
    parser.add_argument("--tasks", type=int, default=10000)
    parser.add_argument("--processes", type=int, default=10)
    options = parser.parse_args()
    print("workers  task lasts  tasks a second  scheduler, ms a task  idle, ms a second"
          "  scheduler, MiB  a worker, MiB")
    for workers in options.workers:
        measured = Measurement(workers, options.processes)
        idle = measured.idle()
        for seconds in (0, max(workers / 500, 0.002)):
            rate, cost = measured.tasks(options.tasks, seconds)
            print(f"{workers:7}{seconds:10.3f} s{rate:16.0f}{cost * 1e3:22.2f}{idle * 1e3:19.1f}"
                  f"{measured.memory.value:16.0f}{measured.memory_of_worker:15.2f}", flush=True)
        measured.close()


if __name__ == "__main__":
    main()
