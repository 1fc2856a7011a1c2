"""A skeleton of single pixels as branches between nodes."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray

FREE = -1
"""In place of a node: an end that leads nowhere."""
_AROUND = np.ones((3, 3), dtype=np.int64)


@dataclass(frozen=True, eq=False, slots=True)
class Branch:
    """points: (n, 2) rows and columns, from one node to the other, without the nodes themselves. nodes: where it begins
    and ends, each a node or FREE; of a ring both are FREE, and it ends as it begins. half_width: px, of what is drawn
    along it."""

    points: FloatArray
    nodes: tuple[int, int]
    half_width: float


@dataclass(frozen=True, eq=False, slots=True)
class SkeletonGraph:
    """places: (n, 2) of the nodes; half_widths: (n,) px of what is drawn there, from its middle to its edge."""

    branches: list[Branch]
    places: FloatArray
    half_widths: FloatArray

    def ends_at_nodes(self) -> dict[int, list[tuple[Branch, int]]]:
        """Of each node that has any, the branches that end there, and with which of their ends."""
        found: dict[int, list[tuple[Branch, int]]] = defaultdict(list)
        for branch in self.branches:
            for side, node in enumerate(branch.nodes):
                if node != FREE:
                    found[node].append((branch, side))
        return found

    def length(self, branch: Branch) -> float:
        """From node to node, px."""
        before, after = (self.places[node : node + 1] if node != FREE else np.empty((0, 2)) for node in branch.nodes)
        return float(np.hypot(*np.diff(np.concatenate((before, branch.points, after)), axis=0).T).sum())


def skeleton_graph(skeleton: BoolArray, half_widths: FloatArray) -> SkeletonGraph:
    """skeleton: (rows, columns), with a free border. half_widths: likewise, px from each pixel to the edge of what is
    drawn. Pixels with more than two neighbours make the nodes, neighbours of them one together."""
    from scipy.ndimage import convolve, label

    n_around = convolve(skeleton.astype(np.int64), _AROUND, mode="constant") - 1
    is_node = skeleton & (n_around > 2)
    labels, n_nodes = label(is_node, _AROUND)
    node_of: IntArray = labels.astype(np.int64)
    chain_of, n_chains = label(skeleton & ~is_node, _AROUND)
    found = np.argwhere(is_node)
    number = node_of[is_node] - 1
    sizes = np.maximum(np.bincount(number, minlength=n_nodes), 1)
    places = np.stack([np.bincount(number, found[:, axis], n_nodes) / sizes for axis in (0, 1)], axis=1)
    widest = np.zeros(n_nodes)
    np.maximum.at(widest, number, half_widths[is_node])
    pixels = np.argwhere(chain_of > 0)
    order = np.argsort(chain_of[chain_of > 0], kind="stable")
    firsts = np.searchsorted(np.sort(chain_of[chain_of > 0]), np.arange(1, n_chains + 2))
    pixels = pixels[order]
    branches = [
        _branch([(int(row), int(column)) for row, column in pixels[begin:end]], node_of, half_widths)
        for begin, end in zip(firsts[:-1].tolist(), firsts[1:].tolist(), strict=True)
    ]
    return SkeletonGraph(branches, places, widest)


def _branch(pixels: list[tuple[int, int]], node_of: IntArray, half_widths: FloatArray) -> Branch:
    """The pixels of a chain in their order, and the nodes at its ends."""
    half_width = float(np.median([half_widths[pixel] for pixel in pixels]))
    left = set(pixels)
    first = next((pixel for pixel in pixels if len(_near(pixel, left)) < 2), pixels[0])
    way = [first]
    left.discard(first)
    while near := _near(way[-1], left):
        way.append(near[0])
        left.discard(near[0])
    begin, end = _nodes_at(way[0], node_of), _nodes_at(way[-1], node_of)
    if len(way) == 1:
        both = [*begin, FREE, FREE][:2]
        return Branch(np.array(way, dtype=np.float64), (both[0], both[1]), half_width)
    if not begin and not end and len(way) > 3 and way[-1] in _near(way[0], set(way)):
        way.append(way[0])
    nodes = (begin[0] if begin else FREE, end[0] if end else FREE)
    return Branch(np.array(way, dtype=np.float64), nodes, half_width)


def _near(pixel: tuple[int, int], among: set[tuple[int, int]]) -> list[tuple[int, int]]:
    """Neighbours, those beside it before those across a corner."""
    row, column = pixel
    steps = ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))
    return [(row + down, column + right) for down, right in steps if (row + down, column + right) in among]


def _nodes_at(pixel: tuple[int, int], node_of: IntArray) -> list[int]:
    row, column = pixel
    around = np.unique(node_of[row - 1 : row + 2, column - 1 : column + 2])
    return [int(node) - 1 for node in around if node > 0]
