"""Work chunks, done in this process and processes beside it, or on a Dask cluster.

Results come in the order of the work chunks, whoever did them, so that nothing of the outcome depends on the number of
workers. The doorway to loky, whose processes start without running the main module anew, and to Dask.
"""

from __future__ import annotations

import importlib.util
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from planner.errors import PlannerError, UsageError

if TYPE_CHECKING:  # a second process is more than most drawings take
    from concurrent.futures import Executor, Future

Chunk = TypeVar("Chunk")
Result = TypeVar("Result")

THREAD_VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""One thread of linear algebra a process: matrices here are too small to share out."""
_WATCH_S = 0.5
_FIRST_ANSWER_S = 10
_AT_HAND = 2
"""Work chunks that each of the others has at a time: one that it works on and one to go on with."""
_AHEAD = 4
"""Results a worker that may wait for an earlier one."""


@dataclass(frozen=True, slots=True)
class Workers:
    """count: processes on this machine, of which this one is one; cluster: tcp://HOST:PORT of a Dask scheduler
    that does the work instead."""

    count: int = 1
    cluster: str | None = None

    @property
    def are_here(self) -> bool:
        """Whether this very process does the work."""
        return self.cluster is None and self.count == 1


ALONE = Workers()


class ChunkExecutor(Protocol):
    """Runs work chunks: this process alone, with others, or a cluster."""

    def __call__(self, work: Callable[[Chunk], Result], chunks: Iterable[Chunk]) -> Iterator[Result]:
        """The results of all work chunks in their order."""
        ...


@contextmanager
def executor_of(workers: Workers, prepare: Callable[[], None] | None = None) -> Iterator[ChunkExecutor]:
    """An executor, for as long as it is needed. Each process beside this one calls `prepare` as it starts. Errors:
    UsageError where the cluster cannot be had."""
    if workers.are_here:
        yield _in_turn
    elif workers.cluster is None:
        with _processes(workers.count - 1, prepare) as executor:
            yield partial(_shared, executor, workers.count - 1, True)
    else:
        with _cluster(workers.cluster) as client, client.get_executor() as executor:
            yield partial(_on_cluster, partial(_shared, executor, sum(client.ncores().values()), False))


def _in_turn(work: Callable[[Chunk], Result], chunks: Iterable[Chunk]) -> Iterator[Result]:
    return map(work, chunks)


def _shared(
    executor: Executor, n_others: int, joins_in: bool, work: Callable[[Chunk], Result], chunks: Iterable[Chunk]
) -> Iterator[Result]:
    """Work chunks go to the others as long as these have too few at hand. This process does the next one itself where
    it joins in, else it waits."""
    from concurrent.futures import FIRST_COMPLETED, wait

    due: deque[Future[Result]] = deque()
    try:
        for chunk in chunks:
            while len(busy := [future for future in due if not future.done()]) >= _AT_HAND * n_others and not joins_in:
                wait(busy, return_when=FIRST_COMPLETED)
            due.append(executor.submit(work, chunk) if len(busy) < _AT_HAND * n_others else _done(work, chunk))
            while due and (due[0].done() or len(due) >= _AHEAD * (n_others + 1)):
                yield due.popleft().result()
        while due:
            yield due.popleft().result()
    finally:
        for future in due:
            future.cancel()


def _on_cluster(shared: ChunkExecutor, work: Callable[[Chunk], Result], chunks: Iterable[Chunk]) -> Iterator[Result]:
    return shared(partial(_one_at_a_time, work), chunks)


_at_work = threading.Lock()


def _one_at_a_time(work: Callable[[Chunk], Result], chunk: Chunk) -> Result:
    """Threads of one process take turns: they share the models of the arm, and these their buffers."""
    with _at_work:
        return work(chunk)


def _done(work: Callable[[Chunk], Result], chunk: Chunk) -> Future[Result]:
    """The work, done here and now; an error waits for its turn, as everyone else's do."""
    from concurrent.futures import Future

    future: Future[Result] = Future()
    try:
        future.set_result(work(chunk))
    except Exception as error:
        future.set_exception(error)
    return future


@contextmanager
def _processes(count: int, prepare: Callable[[], None] | None) -> Iterator[Executor]:
    """Processes that start at once, and are gone in the end, however it comes."""
    from loky import ProcessPoolExecutor

    executor = ProcessPoolExecutor(
        count, initializer=_settle_in, initargs=(os.getpid(), prepare), env=dict.fromkeys(THREAD_VARIABLES, "1")
    )
    try:
        with _interrupts_held():
            executor.submit(int)  # nothing, but processes start with the first task
        yield executor
    except BaseException:
        executor.shutdown(kill_workers=True)
        raise
    executor.shutdown(wait=False)


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Ctrl-C waits until this is over, and processes and threads started in here never see it: one that it met
    half-way through its start would leave its parent waiting."""
    if sys.platform == "win32":  # has no such signals to hold
        yield
    else:
        import multiprocessing.resource_tracker

        from loky.backend import resource_tracker

        resource_tracker.ensure_running()  # the start of either would let interrupts through again
        multiprocessing.resource_tracker.ensure_running()
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _settle_in(parent: int, prepare: Callable[[], None] | None) -> None:
    """A worker process leaves Ctrl-C to its parent, and ends when the parent is gone, however that ended."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(_WATCH_S)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
    if prepare:
        with suppress(PlannerError):  # whoever needs what could not be prepared meets the same error
            prepare()


@contextmanager
def _cluster(address: str) -> Iterator[Any]:
    """A client of the Dask scheduler at that address. Errors: UsageError."""
    if importlib.util.find_spec("distributed") is None:
        raise UsageError(
            f"--workers {address} needs the optional extra 'dask': pip install 'drawing-arm-planner[dask]'"
        )
    from distributed import Client

    try:
        client = Client(address, timeout=_FIRST_ANSWER_S, set_as_default=False)
    except (OSError, ValueError, ImportError) as error:
        raise UsageError(f"no Dask scheduler answers at {address}: {error}") from error
    with client:
        try:
            client.wait_for_workers(1, timeout=_FIRST_ANSWER_S)
        except TimeoutError as error:
            raise UsageError(f"the Dask scheduler at {address} has no workers") from error
        yield client
