"""Work in portions: in this process, in processes beside it, or on a Dask cluster.

Results come in the order of the portions, whoever did them, so that nothing of the outcome depends on the number of
workers. The doorway to joblib.
"""

from __future__ import annotations

import importlib.util
import multiprocessing.resource_tracker
import os
import signal
import threading
import time
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from planner.errors import UsageError

Portion = TypeVar("Portion")
Result = TypeVar("Result")

_WATCH_S = 0.5


@dataclass(frozen=True, slots=True)
class Workers:
    """count: processes on this machine, 1 for this process alone; cluster: tcp://HOST:PORT of a Dask scheduler
    that does the work instead."""

    count: int = 1
    cluster: str | None = None

    @property
    def are_here(self) -> bool:
        """Whether this very process does the work."""
        return self.cluster is None and self.count == 1


ALONE = Workers()


class Crew(Protocol):
    """Those who do the work."""

    def __call__(self, work: Callable[[Portion], Result], portions: Iterable[Portion]) -> Iterator[Result]:
        """The results of all portions in their order. One call at a time: exhaust it before the next."""
        ...


@contextmanager
def crew_of(workers: Workers) -> Iterator[Crew]:
    """The crew, for as long as it is needed. Errors: UsageError where the cluster cannot be had."""
    if workers.are_here:
        yield _in_turn
        return
    from joblib import Parallel, delayed, parallel_config

    with ExitStack() as until_done:
        until_done.enter_context(warnings.catch_warnings())
        warnings.filterwarnings("ignore", ".*have been cancelled", UserWarning)  # whoever gives up half-way knows
        if workers.cluster is None:
            # One thread of linear algebra a process; no files in shared memory, which a kill would leave behind.
            until_done.enter_context(parallel_config(
                "loky", n_jobs=workers.count, inner_max_num_threads=1, max_nbytes=None, initializer=_settle_in,
                initargs=(os.getpid(),)))
        else:
            client = until_done.enter_context(_cluster(workers.cluster))
            until_done.enter_context(parallel_config("dask", n_jobs=-1, client=client))
        parallel = until_done.enter_context(Parallel(return_as="generator", batch_size=1, pre_dispatch="2*n_jobs"))

        def crew(work: Callable[[Portion], Result], portions: Iterable[Portion]) -> Iterator[Result]:
            with _interrupts_held():
                results: Generator[Result, None, None] = parallel(delayed(work)(portion) for portion in portions)
            until_done.callback(results.close)
            return results

        yield crew


def _in_turn(work: Callable[[Portion], Result], portions: Iterable[Portion]) -> Iterator[Result]:
    return map(work, portions)


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Ctrl-C waits until this is over, and processes and threads started in here never see it: one that it met
    half-way through its start would leave its parent waiting."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from joblib.externals.loky.backend import resource_tracker

    resource_tracker.ensure_running()  # the start of either would let interrupts through again
    multiprocessing.resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _settle_in(parent: int) -> None:
    """A worker process leaves Ctrl-C to its parent, and ends when the parent is gone, however that ended."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(_WATCH_S)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _cluster(address: str) -> Iterator[Any]:
    """A client of the Dask scheduler at that address. Errors: UsageError."""
    if importlib.util.find_spec("distributed") is None:
        raise UsageError(f"--workers {address} needs the optional extra 'dask':"
                         " pip install 'drawing-arm-planner[dask]'")
    from distributed import Client

    try:
        client = Client(address, timeout="10s", set_as_default=False)
    except (OSError, ValueError, ImportError) as error:
        raise UsageError(f"no Dask scheduler answers at {address}: {error}") from error
    with client:
        yield client
