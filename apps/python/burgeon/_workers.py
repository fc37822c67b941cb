"""Independent jobs: in this process, on processes of this machine, or on those of a Ray cluster."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import Any, Callable, Iterable, Iterator, List, Optional, Sequence, Tuple

TRIES = 5
"""Most attempts at a job whose worker was killed."""

STOPPED = 130
"""Exit status of a process after Ctrl-C."""


def results(
    task: "Callable[..., Any]",
    common: "Tuple[Any, ...]",
    items: "Iterable[Any]",
    *,
    workers: "Optional[int]" = None,
    ray: bool = False,
) -> "Iterator[Any]":
    """Yields ``task(*common, item)`` for each item, in the order of completion.

    ``task``: a function of a module, which may run anywhere; ``workers``: number of processes (1: this one; default as many as
    the machine has cores); ``ray``: tasks of the Ray cluster that ``ray.init`` has joined, or of one on this machine. A job whose
    worker was killed is done again.
    """
    jobs = list(items)
    if ray:
        yield from _with_ray(task, common, jobs, workers)
    elif workers == 1 or len(jobs) <= 1:
        for item in jobs:
            yield task(*common, item)
    else:
        yield from _with_processes(task, common, jobs, workers)


@contextlib.contextmanager
def _without_main() -> "Iterator[None]":
    """Keeps new processes from running the main program again: they need nothing of it, and one without the guard ``if __name__
    == "__main__"`` would start them over and over."""
    import types

    main = sys.modules["__main__"]
    sys.modules["__main__"] = types.ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


def _alone(task: "Callable[..., Any]", *arguments: Any) -> Any:
    """Does a job in its own process: there are as many of these as cores, so each computes with one thread."""
    from . import set_threads

    set_threads(1)
    return task(*arguments)


def _begin_worker() -> None:
    """Makes Ctrl-C stop only a process with a job; one that waits for a job ends with its pool."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _in_pool(task: "Callable[..., Any]", common: "Tuple[Any, ...]", item: Any) -> Any:
    """Does one job in a process of a pool. After Ctrl-C, with its drafts deleted, the process ends silently: the next job may
    already wait for it."""
    import signal

    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return _alone(task, *common, item)
    except KeyboardInterrupt:
        os._exit(STOPPED)
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def _with_processes(
    task: "Callable[..., Any]", common: "Tuple[Any, ...]", items: "List[Any]", workers: "Optional[int]"
) -> "Iterator[Any]":
    import multiprocessing
    import signal
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from concurrent.futures.process import BrokenProcessPool

    left, tries, others = list(range(len(items))), 0, set(multiprocessing.active_children())
    # Forked processes would share locks of threads that they do not have.
    context = multiprocessing.get_context("spawn")
    while left:
        done, failed = set(), False
        count = min(workers or os.cpu_count() or 1, len(left))
        with ProcessPoolExecutor(count, mp_context=context, initializer=_begin_worker) as pool:
            with _without_main():
                jobs = {pool.submit(_in_pool, task, common, items[k]): k for k in left}
            try:
                for job in as_completed(jobs):
                    try:
                        made = job.result()
                    except BrokenProcessPool:
                        failed = True
                        continue
                    done.add(jobs[job])
                    yield made
            except BaseException:
                # A terminal sends Ctrl-C to all processes; a signal to this process alone is meant for them, too.
                for worker in set(multiprocessing.active_children()) - others:
                    if os.name == "posix" and worker.pid is not None:
                        with contextlib.suppress(ProcessLookupError):
                            os.kill(worker.pid, signal.SIGINT)
                pool.shutdown(wait=True, cancel_futures=True)
                raise
        # A worker was killed: its job, and those that waited, go to new ones.
        left = [k for k in left if k not in done]
        tries = tries + 1 if failed and not done else 0
        if tries >= TRIES:
            raise RuntimeError(f"workers were killed {TRIES} times in a row; is there too little memory for {len(left)} jobs?")


def _with_ray(
    task: "Callable[..., Any]", common: "Tuple[Any, ...]", items: "Sequence[Any]", workers: "Optional[int]"
) -> "Iterator[Any]":
    try:
        import ray
    except ImportError as error:
        raise ImportError("ray=True needs Ray: pip install 'ray>=2' (or leave ray out: workers=N)") from error
    if not ray.is_initialized():
        ray.init(num_cpus=workers, include_dashboard=False, log_to_driver=False)
    # Ray replaces a worker that is killed, and does its job again. Its process and the dashboard show the name of the job.
    remote = ray.remote(num_cpus=1, max_retries=TRIES)(_alone).options(name=task.__name__)
    # Sent once, not with each job.
    shared = [ray.put(value) for value in common]
    jobs = [remote.remote(task, *shared, item) for item in items]
    try:
        while jobs:
            done, jobs = ray.wait(jobs)
            yield from ray.get(done)
    finally:
        for job in jobs:
            ray.cancel(job)
