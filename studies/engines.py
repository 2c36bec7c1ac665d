"""Ways to run batches of points: here, on the cores of this machine, on a Dask cluster."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import fmu_worker
from fmu_worker import Kit

if TYPE_CHECKING:
    from distributed import LocalCluster

Batch = list[int]
Fail = Callable[[int, str], str]
"""Makes the journal's line of a point that failed."""


def serial(kit: Kit, batches: list[Batch], _fail: Fail) -> Iterator[list[str]]:
    digest = kit.digest()
    for batch in batches:
        yield fmu_worker.run(kit, digest, batch)


def joblib(kit: Kit, batches: list[Batch], _fail: Fail, jobs: int) -> Iterator[list[str]]:
    from joblib import Parallel, delayed

    digest = kit.digest()
    parallel = Parallel(n_jobs=jobs, return_as="generator_unordered", batch_size=1)
    yield from parallel(delayed(fmu_worker.run)(kit, digest, batch) for batch in batches)


def dask(kit: Kit, batches: list[Batch], fail: Fail, jobs: int,
         scheduler: str | None) -> Iterator[list[str]]:
    """Batches of workers that are lost go to others; a point that kills its workers has failed."""
    from distributed import Client, WorkerPlugin, as_completed
    from distributed.scheduler import KilledWorker

    class Plugin(fmu_worker.KitPlugin, WorkerPlugin):
        name = f"tread-sweep-{kit.digest()[:16]}"

    with nullcontext(scheduler) if scheduler else local_cluster(jobs) as cluster, Client(cluster) as client:
        client.upload_file(str(Path(fmu_worker.__file__)))
        client.register_plugin(Plugin(kit))
        submit = lambda batch: client.submit(fmu_worker.run_delivered, Plugin.name, batch, pure=False)
        running = {future: batch for batch in batches for future in [submit(batch)]}
        queue = as_completed(list(running))
        for future in queue:
            batch = running.pop(future)
            try:
                yield future.result()
            except KilledWorker as error:
                if len(batch) == 1:
                    yield [fail(batch[0], f"its workers died: {error.task}")]
                    continue
                for point in batch:
                    again = submit([point])
                    running[again] = [point]
                    queue.add(again)
            future.release()


@contextmanager
def local_cluster(jobs: int) -> Iterator[LocalCluster]:
    """Workers on this machine, one thread each.

    A heartbeat that is under way while they close logs a traceback (dask/distributed, issue 9032), after all
    results have arrived: from here on the logs say nothing that a user could act on.
    """
    from distributed import Client, LocalCluster

    with LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address=None) as cluster:
        yield cluster
        with Client(cluster) as client:
            client.run(logging.disable, logging.ERROR)


def cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
