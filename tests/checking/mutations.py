"""Seeded faults: ways to spoil a sound trajectory file, each by more than the check tolerates.

A mutation changes a sheet, or puts another arm or drawing in its place, and gives None where the trajectory has nothing
that it could spoil. All go through the text of a file, as faults do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from planner.arrays import FloatArray, IntArray
from tests.checking.sheet import Sheet

Mutation = Callable[[Sheet], "Sheet | None"]


def _amid(sheet: Sheet) -> int:
    """A sample amid the longest stroke, that of its middle half before which joints move most: at a corner, where they
    hardly move, a row more or less is next to no fault."""
    lengths = np.bincount(sheet.stroke[sheet.pen])
    rows = np.flatnonzero(sheet.stroke == int(np.argmax(lengths)))
    middle = rows[len(rows) // 4 : -(len(rows) // 4) or None]
    moved = np.abs(np.diff(sheet.positions, axis=0, prepend=sheet.positions[:1])).max(axis=1)
    return int(middle[np.argmax(moved[middle])])


def _aloft(sheet: Sheet) -> int:
    """The sample where the pen is highest between two strokes."""
    down = np.flatnonzero(sheet.pen)
    height = np.where(sheet.pen, -np.inf, sheet.tip_mm()[:, 2])
    return down[0] + int(np.argmax(height[down[0] : down[-1]]))


def _bump(sheet: Sheet, centre: int, offset_mm: tuple[float, float, float], half: int = 8) -> Sheet:
    samples = np.arange(max(centre - half, 1), min(centre + half + 1, len(sheet.cells) - 1))
    weight = (1 - (np.abs(samples - centre) / (half + 1)) ** 2) ** 4
    return sheet.lead_mm(samples, weight[:, None] * np.array(offset_mm))


def _joint_at(sheet: Sheet, joint: int, sample: int, jerks: float) -> Sheet:
    """One joint moved at one sample by as much as its jerk limit makes of a step, times a number."""
    positions = sheet.positions
    positions[sample, joint] += jerks * sheet.arm.to_file_units(sheet.arm.max_jerk)[joint] / sheet.rate_hz**3
    return sheet.with_positions(positions)


def _tighter(order: int, by: float) -> Mutation:
    """The arm that may move so much less than the trajectory does, in the joint that uses most of its limit."""
    name = ("max_velocity", "max_acceleration", "max_jerk")[order - 1]

    def mutate(sheet: Sheet) -> Sheet:
        used = np.abs(np.diff(sheet.positions, n=order, axis=0)).max(axis=0) * sheet.rate_hz**order
        limits = sheet.arm.to_file_units(getattr(sheet.arm, name))
        joint = int(np.argmax(used / limits))
        unit = float(limits[joint] / getattr(sheet.arm.joints[joint], name))
        return _with_joint(sheet, joint, **{name: float(used[joint]) / unit / (1 + by)})

    return mutate


def _with_joint(sheet: Sheet, joint: int, **values: float) -> Sheet:
    joints = list(sheet.arm.joints)
    joints[joint] = replace(joints[joint], **values)  # type: ignore[arg-type]
    return replace(sheet, arm=replace(sheet.arm, joints=tuple(joints)))


def _beyond(sheet: Sheet, side: str, by: float) -> Sheet:
    """The arm whose joint ends a little before where the trajectory takes it: the one that moves most."""
    joint = int(np.argmax(np.ptp(sheet.arm.from_file_units(sheet.positions), axis=0)))
    reached = sheet.arm.from_file_units(sheet.positions)[:, joint]
    end = reached.max() - by if side == "maximum" else reached.min() + by
    return _with_joint(sheet, joint, **{side: float(end)})


def _labels(sheet: Sheet, change: Callable[[IntArray], IntArray]) -> Sheet:
    return sheet.with_strokes(change(sheet.stroke.copy()))


def _edge(sheet: Sheet, *, end: bool, by: int, tap: bool = False) -> Sheet | None:
    """The flag of one stroke longer (by > 0) or shorter at one end."""
    stroke = sheet.stroke
    lengths = np.bincount(stroke[stroke >= 0])
    tips = sheet.tip_mm()
    extents = np.array([np.ptp(tips[stroke == label], axis=0).max() for label in range(len(lengths))])
    label = int(np.argmin(extents) if tap else np.argmax(lengths))
    if tap and (extents[label] > 1e-3 or lengths[label] <= -by):
        return None
    drawn = np.flatnonzero(stroke == label)
    if end:
        changed = np.arange(drawn[-1] + 1, drawn[-1] + 1 + by) if by > 0 else drawn[by:]
    else:
        changed = np.arange(drawn[0] - by, drawn[0]) if by > 0 else drawn[:-by]
    stroke[changed] = label if by > 0 else -1
    return sheet.with_strokes(stroke)


def _map(sheet: Sheet, linear: FloatArray, shift_mm: tuple[float, float] = (0.0, 0.0)) -> Sheet:
    """The header's map followed by another one about the middle of what is drawn."""
    a, b, c, d, e, f = map(float, sheet.head["svg_to_arm_mm"].split())
    affine = np.array([[a, c, e], [b, d, f]])
    tips = sheet.tip_mm()[sheet.pen, :2]
    middle = (tips.min(axis=0) + tips.max(axis=0)) / 2
    moved = np.column_stack((linear @ affine[:, :2], linear @ (affine[:, 2] - middle) + middle + shift_mm))
    return sheet.told(svg_to_arm_mm=" ".join(repr(float(value)) for value in moved.T.ravel()))


def _redrawn(sheet: Sheet, linear: FloatArray) -> Sheet:
    """The same with the drawing changed the other way, so that map and pen path agree: only the page is betrayed."""
    moved = _map(sheet, linear)
    a, b, c, d, e, f = map(float, moved.head["svg_to_arm_mm"].split())
    one = np.array([[a, c, e], [b, d, f], [0, 0, 1]])
    a, b, c, d, e, f = map(float, sheet.head["svg_to_arm_mm"].split())
    other = np.array([[a, c, e], [b, d, f], [0, 0, 1]])
    back = np.linalg.solve(one, other)
    outlines = tuple(
        replace(outline, beziers=outline.beziers @ back[:2, :2].T + back[:2, 2]) for outline in sheet.drawing.outlines
    )
    return replace(moved, drawing=replace(sheet.drawing, outlines=outlines, scene=None))


def _turn(degrees: float) -> FloatArray:
    angle = np.radians(degrees)
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _flattened_travel(sheet: Sheet, height_mm: float) -> Sheet:
    """The pen goes over the paper at a height below the clearance, from one stroke to the next."""
    top = _aloft(sheet)
    down = np.flatnonzero(sheet.pen)
    samples = np.arange(down[down < top][-1] + 1, down[down > top][0])
    offsets = np.zeros((len(samples), 3))
    offsets[:, 2] = np.minimum(height_mm - sheet.tip_mm()[samples, 2], 0.0)
    return sheet.lead_mm(samples, offsets)


def _slanted(sheet: Sheet, by_mm: float) -> Sheet:
    """The pen leaves the paper sideways."""
    last = int(np.flatnonzero(sheet.pen[:-1] & ~sheet.pen[1:])[0])
    samples = np.arange(last + 1, last + 40)
    height = sheet.tip_mm()[samples, 2]
    samples = samples[: int(np.argmax(height > 0.7 * height.max())) or 1]
    height = sheet.tip_mm()[samples, 2]
    offsets = np.zeros((len(samples), 3))
    offsets[:, 1] = by_mm * np.clip(height / 0.5, 0.0, 1.0)
    return sheet.lead_mm(samples, offsets)


def _without(sheet: Sheet, label: int) -> Sheet:
    stroke = sheet.stroke
    stroke[stroke == label] = -1
    stroke[stroke > label] -= 1
    return sheet.with_strokes(stroke)


def _uncoupled(sheet: Sheet, samples: slice) -> Sheet | None:
    if not sheet.arm.couplings:
        return None
    positions = sheet.positions
    positions[samples, sheet.arm.couplings[0].joint] += 2e-4
    return sheet.with_positions(positions)


def _drawing(change: Callable[[tuple[FloatArray, ...]], list[FloatArray]]) -> Mutation:
    """Another drawing than the one that was planned: what is too much in one is missing in the other."""

    def mutate(sheet: Sheet) -> Sheet:
        outlines = sheet.drawing.outlines
        changed = change(tuple(outline.beziers for outline in outlines))
        return replace(
            sheet,
            drawing=replace(
                sheet.drawing,
                outlines=tuple(replace(outlines[0], beziers=beziers) for beziers in changed),
                scene=None,
            ),
        )

    return mutate


def _user_mm(sheet: Sheet) -> float:
    """User units in a millimetre of paper."""
    a, b, *_ = map(float, sheet.head["svg_to_arm_mm"].split())
    return 1 / float(np.hypot(a, b))


def _shifted_outline(sheet: Sheet) -> Sheet:
    shift = 0.1 * _user_mm(sheet)
    mutated = _drawing(lambda outlines: [*outlines[:-1], outlines[-1] + shift])(sheet)
    assert mutated is not None
    return mutated


def _swapped(sheet: Sheet, one: int, other: int, *, names: bool) -> Sheet:
    order = list(range(len(sheet.names)))
    order[one], order[other] = order[other], order[one]
    if names:
        return replace(sheet, names=[sheet.names[index] for index in order])
    return replace(sheet, cells=sheet.cells[:, order])


def _all_shifted(sheet: Sheet, by: int) -> Sheet:
    return sheet.with_strokes(np.roll(sheet.stroke, by))


def _but(sheet: Sheet, sample: int) -> IntArray:
    return np.delete(np.arange(len(sheet.cells)), sample)


MUTATIONS: dict[str, Mutation] = {
    "first joint moved at one sample": lambda s: _joint_at(s, 0, _aloft(s), 2.5),
    "second joint moved at one sample": lambda s: _joint_at(s, 1, _amid(s), 2.5),
    "last joint moved at one sample": lambda s: _joint_at(s, s.arm.n_joints - 1, _amid(s), -2.5),
    "velocity 1 % too high": _tighter(1, 0.01),
    "velocity 20 % too high": _tighter(1, 0.2),
    "acceleration 1 % too high": _tighter(2, 0.01),
    "acceleration 20 % too high": _tighter(2, 0.2),
    "jerk 1 % too high": _tighter(3, 0.01),
    "jerk 20 % too high": _tighter(3, 0.2),
    "beyond the upper limit of a joint": lambda s: _beyond(s, "maximum", 1e-6),
    "beyond the lower limit of a joint": lambda s: _beyond(s, "minimum", 1e-6),
    "played 2 % faster": lambda s: replace(s, head={**s.head, "rate_hz": repr(1.02 * s.rate_hz)}).rows(
        np.arange(len(s.cells))
    ),
    "rate doubled": lambda s: replace(s, head={**s.head, "rate_hz": repr(2 * s.rate_hz)}).rows(np.arange(len(s.cells))),
    "rate of the header wrong": lambda s: s.told(rate_hz=repr(1.01 * s.rate_hz)),
    "duration of the header wrong": lambda s: s.told(duration_s=repr(1 + float(s.head["duration_s"]))),
    "one time wrong": lambda s: s.with_cell(9, 0, f"{9.3 / s.rate_hz:.6f}"),
    "all times late": lambda s: replace(s, cells=np.column_stack((np.roll(s.cells[:, 0], -1), s.cells[:, 1:]))),
    "a row lost": lambda s: replace(s, cells=s.cells[_but(s, _amid(s))]),
    "a row lost, times made good": lambda s: s.rows(_but(s, _amid(s))),
    "a row twice": lambda s: replace(s, cells=np.insert(s.cells, _amid(s), s.cells[_amid(s)], axis=0)),
    "a row twice, times made good": lambda s: s.rows(np.sort(np.append(np.arange(len(s.cells)), _amid(s)))),
    "two rows swapped": lambda s: s.rows(
        np.concatenate((np.arange(_amid(s)), [_amid(s) + 1, _amid(s)], np.arange(_amid(s) + 2, len(s.cells))))
    ),
    "cut off at the end": lambda s: s.rows(np.arange(_aloft(s))),
    "begins in motion": lambda s: s.rows(np.arange(_aloft(s), len(s.cells))),
    "begins in a stroke": lambda s: s.rows(np.arange(_amid(s), len(s.cells))),
    "no number": lambda s: s.with_cell(3, 1, "nan"),
    "a cell lost": lambda s: replace(s, cells=s.cells[:, 1:]),
    "pen neither up nor down": lambda s: s.with_cell(3, -2, "2"),
    "first joints swapped": lambda s: _swapped(s, 1, 2, names=False),
    "names of joints swapped": lambda s: _swapped(s, 1, 2, names=True),
    "last joint named otherwise": lambda s: replace(s, names=[*s.names[:-3], "other_deg", *s.names[-2:]]),
    "first joint the other way": lambda s: s.with_positions(np.column_stack((-s.positions[:, 0], s.positions[:, 1:]))),
    "first joint off by 0.1": lambda s: s.with_positions(s.positions + 0.1 * (np.arange(s.arm.n_joints) == 0)),
    "second joint off by 0.1": lambda s: s.with_positions(s.positions + 0.1 * (np.arange(s.arm.n_joints) == 1)),
    "coupling broken at one sample": lambda s: _uncoupled(s, slice(_aloft(s), _aloft(s) + 1)),
    "coupling broken everywhere": lambda s: _uncoupled(s, slice(None)),
    "arm a tenth of a millimetre longer": lambda s: _with_joint(
        s,
        max(range(s.arm.n_joints), key=lambda j: abs(s.arm.joints[j].a_mm)),
        a_mm=0.1 + max((one.a_mm for one in s.arm.joints), key=abs),
    ),
    "arm a tenth of a millimetre higher": lambda s: _with_joint(s, 0, d_mm=0.1 + s.arm.joints[0].d_mm),
    "a stroke not marked": lambda s: _without(s, int(s.stroke[_amid(s)])),
    "the first stroke not marked": lambda s: _without(s, 0),
    "an index twice": lambda s: _labels(s, lambda k: np.where(k > 0, k - 1, k)),
    "an index left out": lambda s: _labels(s, lambda k: np.where(k > 0, k + 1, k)),
    "counted from one": lambda s: _labels(s, lambda k: np.where(k >= 0, k + 1, k)),
    "two indices swapped": lambda s: _labels(s, lambda k: np.select([k == 0, k == 1], [1, 0], k)),
    "pen and stroke at odds": lambda s: s.with_cell(_amid(s), -2, "0"),
    "pen up amid a stroke": lambda s: _labels(s, lambda k: np.where(np.arange(len(k)) == _amid(s), -1, k)),
    "pen down aloft": lambda s: _labels(s, lambda k: np.where(np.arange(len(k)) == _aloft(s), k.max(), k)),
    "pen down at the first sample": lambda s: _labels(s, lambda k: np.where(np.arange(len(k)) == 0, 0, k)),
    "pen down at the last sample": lambda s: _labels(
        s, lambda k: np.where(np.arange(len(k)) == len(k) - 1, k.max() + 1, k)
    ),
    "flag begins a sample early": lambda s: _edge(s, end=False, by=1),
    "flag begins a sample late": lambda s: _edge(s, end=False, by=-1),
    "flag ends a sample early": lambda s: _edge(s, end=True, by=-1),
    "flag ends a sample late": lambda s: _edge(s, end=True, by=1),
    "flag ends two samples late": lambda s: _edge(s, end=True, by=2),
    "flag of a tap begins a sample early": lambda s: _edge(s, end=False, by=1, tap=True),
    "flag of a tap begins a sample late": lambda s: _edge(s, end=False, by=-1, tap=True),
    "flag of a tap ends a sample early": lambda s: _edge(s, end=True, by=-1, tap=True),
    "flag of a tap ends a sample late": lambda s: _edge(s, end=True, by=1, tap=True),
    "all flags a sample early": lambda s: _all_shifted(s, -1),
    "all flags a sample late": lambda s: _all_shifted(s, 1),
    "map turned": lambda s: _map(s, _turn(0.5)),
    "map mirrored": lambda s: _map(s, np.diag([1.0, -1.0])),
    "map scaled": lambda s: _map(s, 1.01 * np.eye(2)),
    "map sheared": lambda s: _map(s, np.array([[1.0, 0.01], [0.0, 1.0]])),
    "map shifted": lambda s: _map(s, np.eye(2), (0.1, 0.0)),
    "map flat": lambda s: s.told(svg_to_arm_mm="1 1 1 1 0 0"),
    "map endless": lambda s: s.told(svg_to_arm_mm="inf 0 0 1 0 0"),
    "page turned": lambda s: _redrawn(s, _turn(0.5)),
    "page mirrored": lambda s: _redrawn(s, np.diag([1.0, -1.0])),
    "page scaled": lambda s: _redrawn(s, 1.01 * np.eye(2)),
    "page sheared": lambda s: _redrawn(s, np.array([[1.0, 0.01], [0.0, 1.0]])),
    "page stretched": lambda s: _redrawn(s, np.diag([1.0, 1.01])),
    "mirror told": lambda s: s.told(mirror="yes"),
    "another scale told": lambda s: s.told(scale=repr(1.01 * float(s.head["scale"]))),
    "another turn told": lambda s: s.told(rotate_deg="1"),
    "a smaller canvas told": lambda s: s.told(margin_mm=repr(1 + float(s.head["margin_mm"]))),
    "something told as left out": lambda s: s.told(left_out_mm="100"),
    "a tap told as left out": lambda s: s.told(left_out_taps="1"),
    "tip 0.06 mm deep in a stroke": lambda s: _bump(s, _amid(s), (0.0, 0.0, -0.06)),
    "tip 0.06 mm high in a stroke": lambda s: _bump(s, _amid(s), (0.0, 0.0, 0.06)),
    "tip 0.2 mm beside a stroke": lambda s: _bump(s, _amid(s), (0.14, 0.14, 0.0)),
    "tip 0.2 mm beside a stroke, both ways": lambda s: _bump(s, _amid(s), (0.14, -0.14, 0.0)),
    "pen dips into the paper on its way": lambda s: _bump(
        s, _aloft(s), (0.0, 0.0, -0.2 - float(s.tip_mm()[_aloft(s), 2])), half=30
    ),
    "travels at half of the clearance": lambda s: _flattened_travel(s, 0.5 * s.arm.pen.clearance_mm),
    "leaves the paper sideways": lambda s: _slanted(s, 0.2),
    "a stroke too much": _drawing(lambda outlines: list(outlines[:-1])),
    "first stroke too much": _drawing(lambda outlines: list(outlines[1:])),
    "a stroke missing": _drawing(lambda outlines: [*outlines, 0.5 * outlines[0][:1] + (5.0, 3.0)]),
    "a stroke 0.1 mm beside": _shifted_outline,
}
"""Each is a kind of its own. Those that change the drawing stand for plans of another one."""
