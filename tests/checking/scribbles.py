"""Random drawings of all that makes it hard to say what is drawn twice: lines over each other, dense, tiny, closed."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np


def random_drawing(rng: np.random.Generator, n_things: int = 5) -> str:
    """An SVG of 100 by 100 units with a few things in it."""
    things = [str(rng.choice(list(KINDS))) for _ in range(n_things)]
    paths = "".join(f'<path d="{KINDS[thing](rng)}"/>' for thing in things)
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100" fill="none" stroke="black">{paths}</svg>'


def _path(points: np.ndarray, closed: bool = False) -> str:
    return "M" + " L".join(f"{x:.4f} {y:.4f}" for x, y in points) + (" Z" if closed else "")


def _place(rng: np.random.Generator, room: float = 0.0) -> np.ndarray:
    return rng.uniform(room, 100 - room, 2)


def _polyline(rng: np.random.Generator) -> str:
    return _path(rng.uniform(0, 100, (int(rng.integers(2, 8)), 2)))


def _curve(rng: np.random.Generator) -> str:
    return "M{:.3f} {:.3f} C{:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f}".format(*rng.uniform(0, 100, 8))


def _closed(rng: np.random.Generator) -> str:
    turn = np.linspace(0, 2 * np.pi, int(rng.integers(3, 30)), endpoint=False)[:, None]
    return _path(_place(rng, 20) + rng.uniform(0.2, 20) * np.hstack((np.cos(turn), np.sin(turn))), closed=True)


def _tiny_scribble(rng: np.random.Generator) -> str:
    steps = rng.normal(0, rng.uniform(0.01, 0.6), (int(rng.integers(3, 40)), 2))
    return _path(_place(rng, 5) + np.cumsum(steps, axis=0))


def _walk(rng: np.random.Generator) -> str:
    return _path(np.clip(_place(rng) + np.cumsum(rng.normal(0, 2, (60, 2)), axis=0), 0, 100))


def _hatch(rng: np.random.Generator) -> str:
    at, spacing, length = _place(rng, 25), rng.uniform(0.02, 1.0), rng.uniform(1, 20)
    return " ".join(_path(at + np.array([(0, k * spacing), (length, k * spacing)])) for k in range(8))


def _snake(rng: np.random.Generator) -> str:
    at, spacing, length = _place(rng, 25), rng.uniform(0.02, 1.0), rng.uniform(1, 20)
    return _path(at + np.array([(length * ((k + 1) // 2 % 2), k // 2 * spacing) for k in range(16)]))


def _doubled(rng: np.random.Generator) -> str:
    line = rng.uniform(0, 100, (int(rng.integers(2, 5)), 2))
    other = line[::-1] if rng.random() < 0.5 else line + rng.uniform(0, 0.1)
    return f"{_path(line)} {_path(other)}"


def _there_and_back(rng: np.random.Generator) -> str:
    line = rng.uniform(0, 100, (2, 2))
    return _path(line[[0, 1, 0, 1][: int(rng.integers(3, 5))]])


def _taps(rng: np.random.Generator) -> str:
    at = _place(rng, 5)
    spread = rng.choice([0.0, 0.02, 0.3, 10.0])
    return " ".join("M{:.4f} {:.4f}h0".format(*np.clip(at + rng.normal(0, spread, 2), 0, 100)) for _ in range(5))


def _tap_on_a_line(rng: np.random.Generator) -> str:
    line = rng.uniform(0, 100, (2, 2))
    return "{} M{:.4f} {:.4f}h0".format(_path(line), *(line.mean(axis=0) if rng.random() < 0.5 else line[0]))


def _dashes(rng: np.random.Generator) -> str:
    begin, end = rng.uniform(0, 100, (2, 2))
    along = (end - begin) / np.linalg.norm(end - begin)
    length, gap = rng.uniform(0.02, 1.0, 2)
    return " ".join(
        _path(np.array([begin + k * (length + gap) * along, begin + (k * (length + gap) + length) * along]))
        for k in range(12)
    )


def _star(rng: np.random.Generator) -> str:
    at, turn = _place(rng, 20), rng.uniform(0, np.pi, 9)[:, None]
    ends = rng.uniform(0.2, 20) * np.hstack((np.cos(turn), np.sin(turn)))
    return " ".join(_path(np.array([at - end, at + end])) for end in ends)


def _touching(rng: np.random.Generator) -> str:
    corners = rng.uniform(0, 100, (6, 2))
    return " ".join(_path(np.array([one, other + rng.uniform(-0.02, 0.02, 2)])) for one, other in pairwise(corners))


KINDS: dict[str, Callable[[np.random.Generator], str]] = {
    "polyline": _polyline,
    "curve": _curve,
    "closed": _closed,
    "tiny scribble": _tiny_scribble,
    "walk": _walk,
    "hatch": _hatch,
    "snake": _snake,
    "doubled": _doubled,
    "there and back": _there_and_back,
    "taps": _taps,
    "tap on a line": _tap_on_a_line,
    "dashes": _dashes,
    "star": _star,
    "touching": _touching,
}
