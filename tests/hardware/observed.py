"""What a player has told."""

from __future__ import annotations

from hardware.playback.observer import Observer, Progress


class Observed(Observer):
    """Keeps the strokes that were sent and finished, and the progress."""

    def __init__(self) -> None:
        self.strokes_sent = list[int]()
        self.strokes_finished = list[int]()
        self.progress = list[Progress]()

    def sent(self, stroke: int) -> None:
        self.strokes_sent.append(stroke)

    def finished(self, stroke: int) -> None:
        self.strokes_finished.append(stroke)

    def progressed(self, progress: Progress) -> None:
        self.progress.append(progress)
