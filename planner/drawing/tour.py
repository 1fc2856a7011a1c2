"""2-opt and Or-opt for a tour of strokes that has a fixed start and a free end.

Each stroke s has two nodes, 2 s and 2 s + 1, its ends; a tour is the row of nodes by which strokes are entered, and
the pen leaves by the other node of the same stroke, `node ^ 1`. Turning a piece of the tour round reverses the row
and swaps entries for exits, which leaves all travel inside the piece as it was.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.drawing.metric import Metric
from planner.drawing.nearest import NearestPoints

_NEIGHBOURS = 8
_LONGEST_SEGMENT = 3
_ROUNDS = 60
# Element moves: reversing a piece of the tour costs its length. Bounds time, the same on every machine.
_WORK_LIMIT = 400_000_000
_GAIN = 1e-9


def improve(
    start: FloatArray,
    entries: FloatArray,
    exits: FloatArray,
    tour: IntArray,
    metric: Metric,
    rounds: int | None = None,
) -> tuple[IntArray, BoolArray, bool]:
    """A tour no longer than `tour`, which strokes it runs the other way, and whether the search came to its end, where
    no move is left that gains, rather than to the limit of its rounds or its work.

    start: (k,); entries, exits: (n_strokes, k), where each stroke is entered and left now; tour: (n_strokes,).
    """
    n = len(tour)
    if n < 2:
        return tour, np.zeros(n, dtype=np.bool_), True
    search = _Search(start, entries, exits, tour, metric)
    is_finished = search.run(_ROUNDS if rounds is None else rounds)
    found = search.tour[1:]
    is_reversed = np.zeros(n, dtype=np.bool_)
    is_reversed[found // 2] = found % 2 == 1
    return found // 2, is_reversed, is_finished


class _Search:
    """Stroke n is the start, both its nodes in one place; it always stands first."""

    def __init__(
        self, start: FloatArray, entries: FloatArray, exits: FloatArray, tour: IntArray, metric: Metric
    ) -> None:
        self.n = len(tour)
        self.metric = metric
        self.nodes: FloatArray = np.stack([np.vstack([entries, start]), np.vstack([exits, start])], axis=1)
        self.nodes = self.nodes.reshape(2 * self.n + 2, -1)
        self.tour: IntArray = np.concatenate([[2 * self.n], 2 * tour])
        self.position = np.empty(self.n + 1, dtype=np.int64)
        self.position[self.tour // 2] = np.arange(self.n + 1)
        k = min(_NEIGHBOURS + 2, len(self.nodes))
        scale = float(np.ptp(self.nodes, axis=0).max())
        self.least_gain = _GAIN * scale
        near = NearestPoints(self.nodes).query(self.nodes, k)[1]
        rows = np.repeat(np.arange(len(self.nodes)), k)
        columns = near.ravel()
        is_other = rows // 2 != columns // 2
        # Pairs of nodes worth linking, and how far apart they are.
        self.a, self.b = rows[is_other], columns[is_other]
        self.apart = self._length(self.a, self.b)
        self.work = 0

    def run(self, rounds: int) -> bool:
        """Whether no move is left that gains."""
        for _ in range(rounds):
            n_moves = self._two_opt_round() + self._or_opt_round()
            if not n_moves:
                return True
            if self.work > _WORK_LIMIT:
                break
        return False

    def _links(self) -> tuple[FloatArray, IntArray, IntArray]:
        """(2 n + 2,) travel at each node as the tour is now, nothing at the free end; and the pairs of which a move may
        gain: of the links that it makes, one at least is shorter than one that it breaks there."""
        link = np.zeros(len(self.nodes))
        left, entered = self.tour[:-1] ^ 1, self.tour[1:]
        link[left] = link[entered] = self._length(left, entered)
        is_worth = self.apart < np.maximum(link[self.a], link[self.b])
        return link, self.a[is_worth], self.b[is_worth]

    def _length(self, one: IntArray, other: IntArray) -> FloatArray:
        """Travel between nodes; nothing where `other` is -1, the free end."""
        distance: FloatArray = self.metric.distance(self.nodes[one], self.nodes[other])
        distance[other < 0] = 0.0
        return distance

    def _after(self, position: IntArray) -> IntArray:
        """The entry node of the stroke that follows `position`, -1 behind the last."""
        is_last = position >= self.n
        following = self.tour[np.where(is_last, 0, position + 1)]
        following[is_last] = -1
        return following

    # 2-opt: turn round the piece from `first` to `last`.

    def _two_opt_gain(self, first: IntArray, last: IntArray, link: FloatArray) -> FloatArray:
        before, after = self.tour[first - 1] ^ 1, self._after(last)
        head, tail = self.tour[first], self.tour[last] ^ 1
        gain: FloatArray = link[head] + link[tail] - self._length(before, tail) - self._length(head, after)
        return gain

    def _two_opt_round(self) -> int:
        link, a, b = self._links()
        position_a, position_b = self.position[a // 2], self.position[b // 2]
        is_exit_a = self.tour[position_a] != a
        is_exit_b = self.tour[position_b] != b
        is_exit_a[position_a == 0] = True
        # Exit linked to a later exit: everything behind the first up to the second turns round.
        exits = is_exit_a & is_exit_b & (position_b > position_a)
        # Entry linked to a later entry: everything from the first to just before the second turns round.
        entries = ~is_exit_a & ~is_exit_b & (position_b > position_a) & (position_a > 0)
        first = np.concatenate([position_a[exits] + 1, position_a[entries]])
        last = np.concatenate([position_b[exits], position_b[entries] - 1])
        # The free end: turning the tail round costs one link only.
        first = np.concatenate([first, np.arange(1, self.n + 1)])
        last = np.concatenate([last, np.full(self.n, self.n)])
        gain = self._two_opt_gain(first, last, link)
        chosen = np.flatnonzero(gain > self.least_gain)
        chosen = chosen[np.lexsort((chosen, -gain[chosen]))]
        # Moves are remembered by the nodes at their borders: earlier moves of this round shift positions.
        borders = np.stack(
            [
                self.tour[first[chosen] - 1],
                self.tour[first[chosen]],
                self.tour[last[chosen]],
                self._after(last[chosen]),
            ],
            axis=1,
        )
        n_moves = 0
        for before, head, tail, after in borders.tolist():
            n_moves += self._turn_round(before, head, tail, after)
        return n_moves

    def _turn_round(self, before: int, head: int, tail: int, after: int) -> bool:
        """Apply a 2-opt move if its two links still stand, in either direction of the tour."""
        i, j = int(self.position[head >> 1]), int(self.position[tail >> 1])
        if self.tour[i] == head and self.tour[j] == tail and i <= j:
            stands = self.tour[i - 1] == before and (
                j == self.n if after < 0 else j < self.n and self.tour[j + 1] == after
            )
        elif self.tour[i] == head ^ 1 and self.tour[j] == tail ^ 1 and j <= i and after >= 0:
            # Turned round as a whole meanwhile: the same links, met the other way.
            stands = self.tour[j - 1] == after ^ 1 and i < self.n and self.tour[i + 1] == before ^ 1
            i, j = j, i
        else:
            return False
        if not stands:
            return False
        self._reverse(i, j)
        return True

    def _reverse(self, i: int, j: int) -> None:
        self.tour[i : j + 1] = self.tour[i : j + 1][::-1] ^ 1
        self.position[self.tour[i : j + 1] >> 1] = np.arange(i, j + 1)
        self.work += j + 1 - i

    # Or-opt: move a short segment between two other neighbours, either way round.

    def _or_opt_round(self) -> int:
        links = self._links()
        moves = [self._or_opt_candidates(length, *links) for length in range(1, min(_LONGEST_SEGMENT, self.n - 1) + 1)]
        gain, first, last, gap, turned = (np.concatenate(column) for column in zip(*moves, strict=True))
        chosen = np.flatnonzero(gain > self.least_gain)
        chosen = chosen[np.lexsort((chosen, -gain[chosen]))]
        rows = np.stack(
            [
                self.tour[first[chosen] - 1],
                self.tour[first[chosen]],
                self.tour[last[chosen]],
                self._after(last[chosen]),
                self.tour[gap[chosen]],
                self._after(gap[chosen]),
                turned[chosen],
            ],
            axis=1,
        )
        n_moves = 0
        for row in rows.tolist():
            n_moves += self._move_segment(*row)
        return n_moves

    def _or_opt_candidates(
        self, length: int, link: FloatArray, a: IntArray, b: IntArray
    ) -> tuple[FloatArray, IntArray, IntArray, IntArray, IntArray]:
        """Gain, first and last position of the segment, the position after which it goes, and whether turned."""
        position_a, position_b = self.position[a // 2], self.position[b // 2]
        is_entry_a = self.tour[position_a] == a
        is_entry_b = self.tour[position_b] == b
        # The segment has node a at one of its outer ends.
        first = np.where(is_entry_a, position_a, position_a - length + 1)
        last = first + length - 1
        # Node b is left (the segment follows it) or entered (the segment precedes it).
        follows = ~is_entry_b | (position_b == 0)
        gap = np.where(follows, position_b, position_b - 1)
        turned = follows != is_entry_a
        is_possible = (first >= 1) & (last <= self.n) & (gap >= 0) & ((gap < first - 1) | (gap > last))
        first, last, gap, turned = first[is_possible], last[is_possible], gap[is_possible], turned[is_possible]
        head, tail = self.tour[first], self.tour[last] ^ 1
        before, after = self.tour[first - 1] ^ 1, self._after(last)
        left, right = self.tour[gap] ^ 1, self._after(gap)
        inner, outer = np.where(turned, tail, head), np.where(turned, head, tail)
        gain = (
            link[head]
            + link[tail]
            + link[left]
            - self._length(before, after)
            - self._length(left, inner)
            - self._length(outer, right)
        )
        return gain, first, last, gap, turned.astype(np.int64)

    def _move_segment(self, before: int, head: int, tail: int, after: int, left: int, right: int, turned: int) -> bool:
        """Apply an Or-opt move if all three links still stand as they were."""
        i, j, gap = (int(self.position[node >> 1]) for node in (head, tail, left))
        ends = [(i - 1, before), (i, head), (j, tail), (gap, left)]
        if any(position < 0 or self.tour[position] != node for position, node in ends):
            return False
        for position, node in ((j, after), (gap, right)):
            if (node >= 0) != (position < self.n) or (node >= 0 and self.tour[position + 1] != node):
                return False
        if j - i >= _LONGEST_SEGMENT or j < i or i - 1 <= gap <= j:
            return False
        segment = self.tour[i : j + 1].copy()
        if turned:
            segment = segment[::-1] ^ 1
        low, high = (gap + 1, j) if gap < i else (i, gap)
        rest = self.tour[low:i] if gap < i else self.tour[j + 1 : gap + 1]
        self.tour[low : high + 1] = np.concatenate([segment, rest] if gap < i else [rest, segment])
        self.position[self.tour[low : high + 1] >> 1] = np.arange(low, high + 1)
        self.work += high + 1 - low
        return True
