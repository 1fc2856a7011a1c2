"""The middle of drawn lines: a skeleton, its spurs cut off, its branches led on through the places where they meet."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.image.seen import SeenPicture
from planner.drawing.image.skeleton import FREE, Branch, SkeletonGraph, skeleton_graph
from planner.drawing.image.threshold import blurred, threshold
from planner.drawing.path_work import simplified
from planner.drawing.raster import block_means
from planner.errors import UsageError

_End = tuple[Branch, int]
_STEPS_PX = 0.7
_FINE = 8
"""Pixels to the finest detail, beyond which more only take time."""
_OFF_PX, _OFF = 0.5, 0.125
_STRAIGHT_ON = -0.5
"""The cosine between two branches at a node from which on they are one line."""
_BRIDGE = 3.0
"""Half widths of a line, between two nodes that are one crossing: at half a right angle they are so far apart."""
_SMOOTHING = 2
"""Times that a line of pixels is averaged with its neighbours: a blur of a pixel."""


def centrelines(picture: SeenPicture, least_mm: float) -> list[FloatArray]:
    """Lines (n, 2), mm; a dot is one of a single point. Spots smaller across than half of `least_mm` have none. Errors:
    UsageError where scikit-image is not installed."""
    try:
        from skimage.morphology import skeletonize
    except ImportError:
        raise UsageError(
            "--image centreline needs scikit-image: pip install 'drawing-arm-planner[image]', or choose another style"
        ) from None
    from scipy.ndimage import distance_transform_edt, label

    darkness, to_mm, pixel_mm = picture.darkness, picture.to_mm, picture.pixel_mm
    factor = min(max(int(least_mm / _FINE / pixel_mm), 1), *darkness.shape)
    if factor > 1:
        darkness, pixel_mm = block_means(darkness, factor), factor * pixel_mm
    is_dark = blurred(darkness, _STEPS_PX) > threshold(darkness)
    spot, n_spots = label(is_dark, np.ones((3, 3)))
    sizes = np.bincount(spot.ravel(), minlength=n_spots + 1)
    is_dark &= sizes[spot] * pixel_mm**2 >= np.pi / 16.0 * least_mm**2
    # Zhang's method, the usual one, eats up ends of slanting lines of two pixels.
    skeleton = np.asarray(skeletonize(is_dark, method="lee"), dtype=np.bool_)
    graph = skeleton_graph(skeleton, distance_transform_edt(is_dark))
    graph = _without_bridges(_without_spurs(graph))
    lines = [_smooth(line) for line in _joined(graph)]
    # Rows and columns of a picture that has a border of one pixel around it.
    moved = [(line[:, ::-1] - 0.5) * factor @ to_mm[:, :2].T + to_mm[:, 2] for line in lines]
    return simplified(moved, min(_OFF_PX * pixel_mm, _OFF * least_mm))


def _without_spurs(graph: SkeletonGraph) -> SkeletonGraph:
    """Without what leads from a node to nowhere and is shorter than what is drawn there is wide. Where nothing else
    meets, the two longest stay."""
    cut: set[Branch] = set()
    for node, ends in graph.ends_at_nodes().items():
        short = [branch for branch, _ in ends if FREE in branch.nodes and _is_short(graph, branch, node)]
        if len(ends) >= 3:
            cut.update(short if len(short) < len(ends) else sorted(short, key=graph.length)[:-2])
    return replace(graph, branches=[branch for branch in graph.branches if branch not in cut])


def _is_short(graph: SkeletonGraph, branch: Branch, node: int) -> bool:
    return bool(graph.length(branch) < 2.0 * graph.half_widths[node])


def _without_bridges(graph: SkeletonGraph) -> SkeletonGraph:
    """Where lines cross, the skeleton has two nodes with a short branch between: these become one."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    is_bridge = [
        FREE not in branch.nodes
        and all(graph.length(branch) < _BRIDGE * graph.half_widths[node] for node in branch.nodes)
        for branch in graph.branches
    ]
    bridges = np.array([b.nodes for b, short in zip(graph.branches, is_bridge, strict=True) if short], dtype=np.int64)
    first, last = bridges.reshape(-1, 2).T
    n_nodes = len(graph.places)
    links = coo_array((np.ones(len(first)), (first, last)), shape=(n_nodes, n_nodes))
    n_left, node_to = connected_components(links, directed=False)
    sizes = np.bincount(node_to, minlength=n_left)
    places = np.stack([np.bincount(node_to, graph.places[:, axis], n_left) / sizes for axis in (0, 1)], axis=1)
    half_widths = np.zeros(n_left)
    np.maximum.at(half_widths, node_to, graph.half_widths)
    kept = []
    for branch, short in zip(graph.branches, is_bridge, strict=True):
        if not short:
            begin, end = (FREE if node == FREE else int(node_to[node]) for node in branch.nodes)
            kept.append(replace(branch, nodes=(begin, end)))
    return SkeletonGraph(kept, places, half_widths)


def _followers(graph: SkeletonGraph) -> dict[_End, _End]:
    """Which end of a branch leads on to which end of another: at each node the straightest first; two that are alone
    there always do."""
    found: dict[_End, _End] = {}
    for node, ends in graph.ends_at_nodes().items():
        heading = [_heading(graph, end, node) for end in ends]
        pairs = sorted(
            (float(np.dot(heading[i], heading[j])), i, j) for i in range(len(ends)) for j in range(i + 1, len(ends))
        )
        for cosine, i, j in pairs:
            is_one = cosine <= _STRAIGHT_ON or len(ends) == 2
            if is_one and ends[i] not in found and ends[j] not in found:
                found[ends[i]], found[ends[j]] = ends[j], ends[i]
    return found


def _heading(graph: SkeletonGraph, end: _End, node: int) -> FloatArray:
    """(2,) of length 1, from a node along a branch that ends there, as it goes where the node bends it no more."""
    branch, side = end
    way = branch.points if side == 0 else branch.points[::-1]
    away = way[min(int(2.0 * graph.half_widths[node]) + 2, len(way) - 1)] - graph.places[node]
    length = float(np.hypot(*away))
    heading: FloatArray = away / length if length else away
    return heading


def _joined(graph: SkeletonGraph) -> Iterator[FloatArray]:
    """Branches led on through nodes; those that end at a node reach it."""
    follower = _followers(graph)
    meeting = {node: len(ends) for node, ends in graph.ends_at_nodes().items()}
    used: set[Branch] = set()
    ends = [(branch, side) for branch in graph.branches for side in (0, 1)]
    for begin in sorted(ends, key=lambda end: end in follower):
        if begin[0] in used:
            continue
        line: list[FloatArray] = []
        at: _End | None = begin
        while at is not None and at[0] not in used:
            branch, side = at
            used.add(branch)
            line.append(_with_nodes(graph, branch, follower, meeting)[:: 1 if side == 0 else -1])
            at = follower.get((branch, 1 - side))
        if at == begin:  # round and back
            line.append(line[0][:1])
        yield np.concatenate(line)


def _with_nodes(
    graph: SkeletonGraph, branch: Branch, follower: dict[_End, _End], meeting: dict[int, int]
) -> FloatArray:
    """The points of a branch with its nodes. Where several branches meet, the skeleton is bent within the width of the
    lines: that part is left out, and a branch that leads on there does so without the node."""
    points = _with_straight_ends(branch)
    keeps = np.ones(len(points), dtype=np.bool_)
    parts: list[FloatArray] = [np.empty((0, 2)), np.empty((0, 2))]
    for side, node in enumerate(branch.nodes):
        if node == FREE:
            continue
        if meeting[node] > 2:
            keeps &= np.hypot(*(points - graph.places[node]).T) > graph.half_widths[node]
        if meeting[node] <= 2 or (branch, side) not in follower:
            parts[side] = graph.places[node][None]
    if not keeps.any():
        keeps[len(points) // 2] = True
    return np.concatenate((parts[0], points[keeps], parts[1]))


def _with_straight_ends(branch: Branch) -> FloatArray:
    """The points of a branch. Where it ends freely, the skeleton bends to a corner of what is drawn: there it goes
    straight on, as far as it went. What is by itself, and no longer than wide, is a dot."""
    points = branch.points
    if len(points) > 1 and np.all(points[0] == points[-1]):
        return points
    if branch.nodes == (FREE, FREE) and np.hypot(*np.diff(points, axis=0).T).sum() < 2.0 * branch.half_width:
        middle: FloatArray = points.mean(axis=0, keepdims=True)
        return middle
    if branch.nodes[0] == FREE:
        points = _straight_to_the_end(points[::-1], branch.half_width)[::-1]
    if branch.nodes[1] == FREE:
        points = _straight_to_the_end(points, branch.half_width)
    return points


def _straight_to_the_end(points: FloatArray, reach: float) -> FloatArray:
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
    to_go = along[-1] - along
    if along[-1] < 4.0 * reach:
        return points
    before, bend = (points[np.flatnonzero(to_go >= far)[-1]] for far in (3.0 * reach, reach))
    heading = (bend - before) / np.hypot(*(bend - before))
    straight: FloatArray = np.concatenate((points[to_go >= reach], (bend + reach * heading)[None]))
    return straight


def _smooth(line: FloatArray) -> FloatArray:
    """Each point but the ends averaged with its neighbours; a closed line all round."""
    is_closed = len(line) > 3 and bool(np.all(line[0] == line[-1]))
    for _ in range(_SMOOTHING):
        if is_closed:
            around = np.concatenate((line[-2:-1], line, line[1:2]))
            line = (around[:-2] + 2.0 * line + around[2:]) / 4.0
        elif len(line) > 2:
            line = np.concatenate((line[:1], (line[:-2] + 2.0 * line[1:-1] + line[2:]) / 4.0, line[-1:]))
    return line
