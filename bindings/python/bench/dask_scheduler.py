#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Where Dask's scheduler ends: simulated workers that cast nothing, and tasks that only wait.

The workers are objects in a few processes, the scheduler has a process of its own, and a task is a
coroutine that sleeps: so the scheduler's work is the real one and the workers' is little. For each
number of workers, tasks that end at once and tasks that would be 500 a second: how many a second
came about, and the scheduler's processor time a task, whose inverse is its limit on a free core.

usage: dask_scheduler.py [--workers N ...] [--tasks N]
"""

import argparse
import asyncio
import multiprocessing
import os
import time

os.environ.setdefault("DASK_DISTRIBUTED__LOGGING__DISTRIBUTED", "critical")  # children, too

from distributed import Client, Scheduler, Worker

PROCESSES = 2


async def nap(number, seconds):
    """A task: no thread, no processor."""
    await asyncio.sleep(seconds)
    return number


def some_workers(address, count, ready, end):
    async def live():
        workers = [Worker(address, nthreads=1, memory_limit=0, dashboard=False,
                          heartbeat_interval="10s") for _ in range(count)]
        for first in range(0, count, 50):
            await asyncio.gather(*workers[first:first + 50])
        ready.release()
        while not end.is_set():
            await asyncio.sleep(0.5)
        await asyncio.gather(*(worker.close(nanny=False) for worker in workers))
    asyncio.run(live())


def scheduler(address, end, processor_time):
    async def live():
        async with Scheduler(port=0, dashboard=False, host="127.0.0.1") as made:
            address.put(made.address)
            while not end.is_set():
                processor_time.value = time.process_time()
                await asyncio.sleep(0.05)
    asyncio.run(live())


def measure(workers, tasks, seconds):
    """(tasks a second, scheduler's processor seconds a task)."""
    context = multiprocessing.get_context("spawn")
    end, ready, address = context.Event(), context.Semaphore(0), context.Queue()
    processor_time = context.Value("d", 0.0)
    started = [context.Process(target=scheduler, args=(address, end, processor_time))]
    started[0].start()
    where = address.get()
    for part in range(PROCESSES):
        count = workers // PROCESSES + (part < workers % PROCESSES)
        started.append(context.Process(target=some_workers, args=(where, count, ready, end)))
        started[-1].start()
    for _ in range(PROCESSES):
        ready.acquire()
    try:
        with Client(where) as client:
            client.wait_for_workers(workers)
            client.gather(client.map(nap, range(workers), seconds=0, pure=False))
            begin, before = time.perf_counter(), processor_time.value
            client.gather(client.map(nap, range(tasks), seconds=seconds, pure=False))
            wall = time.perf_counter() - begin
            time.sleep(0.2)
            return tasks / wall, (processor_time.value - before) / tasks
    finally:
        end.set()
        for process in started:
            process.join(20)
            process.kill()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 10, 100, 1000])
    parser.add_argument("--tasks", type=int, default=10000)
    options = parser.parse_args()
    print("workers  task lasts  tasks a second  scheduler, ms a task")
    for workers in options.workers:
        for seconds in (0, max(workers / 500, 0.002)):
            rate, cost = measure(workers, options.tasks, seconds)
            print(f"{workers:7}{seconds:10.3f} s{rate:16.0f}{cost * 1e3:22.2f}", flush=True)


if __name__ == "__main__":
    main()
