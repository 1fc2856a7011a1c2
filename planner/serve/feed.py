"""What changes is told to every page that looks on."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from typing import Any

_HEARTBEAT_S = 15.0


class Feed:
    """Everyone who looks on gets the newest state of each part that has changed since they looked last: a page that is
    slow misses steps between, and none takes more memory than there are parts."""

    def __init__(self) -> None:
        self._watchers: set[_Watcher] = set()

    def changed(self, part: str, state: Callable[[], Any]) -> None:
        """state: asked for when it is sent."""
        for watcher in self._watchers:
            watcher.due[part] = state
            watcher.woken.set()

    async def messages(self) -> AsyncIterator[str]:
        """Server-sent events, for as long as somebody listens."""
        watcher = _Watcher()
        self._watchers.add(watcher)
        try:
            yield "retry: 1000\n\n"
            while True:
                try:
                    await asyncio.wait_for(watcher.woken.wait(), _HEARTBEAT_S)
                except TimeoutError:
                    yield ": still here\n\n"
                    continue
                watcher.woken.clear()
                due, watcher.due = watcher.due, {}
                for part, state in due.items():
                    yield f"event: {part.partition(' ')[0]}\ndata: {json.dumps(state())}\n\n"
        finally:
            self._watchers.discard(watcher)


class _Watcher:
    def __init__(self) -> None:
        self.woken = asyncio.Event()
        self.due: dict[str, Callable[[], Any]] = {}
