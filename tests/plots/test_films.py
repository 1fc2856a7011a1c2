"""Films show the arm where the trajectory has it, last as long as they should, and are whole, valid files."""

from __future__ import annotations

import base64
import json
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from planner.arms.arm import Arm
from planner.arms.arm_file import known_arms, load_arm
from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.checking.chain import chain_poses
from planner.errors import OutputError, UsageError
from planner.head import PenInk
from planner.kinematics.frame_jacobian import chain_frames
from planner.plots.film import Film
from planner.plots.film_file import film_format, save_film
from planner.plots.look import Look, Theme
from planner.plots.motion import Motion, arm_nodes, link_thicknesses_mm, motion_of, seen_from_the_side
from planner.plots.player import player_page
from planner.redundancy.arm_model import ArmModel
from planner.trajectory import TRAVELLING, Trajectory

SMALL = Look.of(dpi=30)


@pytest.fixture(scope="module")
def make_motion(arm: Arm, make_trajectory: Callable[..., Trajectory]) -> Callable[..., Motion]:
    def make(drawing: str = "flower.svg", **choices: float) -> Motion:
        trajectory = make_trajectory(drawing=drawing)
        tip_mm = chain_poses(arm, arm.from_file_units(trajectory.positions)).tip_mm.T
        return motion_of(trajectory, arm, tip_mm, **choices)

    return make


@pytest.mark.parametrize("paper", [PaperPose(), PaperPose(12.0, -7.0, 3.0, 0.2, -0.1, 0.08)])
@pytest.mark.parametrize("name", known_arms())
def test_the_last_node_is_the_tip_and_links_keep_their_lengths(name: str, paper: PaperPose) -> None:
    arm = replace(load_arm(name), paper=paper)
    low, high = arm.to_file_units(arm.minimum), arm.to_file_units(arm.maximum)
    positions = np.random.default_rng(1).uniform(low, high, (50, arm.n_joints))
    up = np.zeros(50, dtype=bool)
    trajectory = Trajectory(
        name, "", "path", 100.0, arm.column_names, positions, up, np.full(50, TRAVELLING), (1, 0, 0, 1, 0, 0)
    )
    tip_mm = chain_poses(arm, arm.from_file_units(positions)).tip_mm.T
    nodes_mm = motion_of(trajectory, arm, tip_mm).nodes_mm(trajectory.times_s)
    np.testing.assert_allclose(nodes_mm[:, -1], tip_mm, atol=1e-9)
    base_mm = paper.T_paper_base[:3, 3]
    np.testing.assert_allclose(nodes_mm[:, 0], np.tile(base_mm, (50, 1)), atol=1e-12)
    rigid = np.ptp(np.linalg.norm(np.diff(nodes_mm, axis=1), axis=2), axis=0) < 1e-9
    assert np.count_nonzero(~rigid) == sum(joint.file_unit == "mm" for joint in arm.joints)
    side = seen_from_the_side(arm, nodes_mm)
    np.testing.assert_allclose(
        side[:, -1], np.column_stack((np.hypot(*(tip_mm - base_mm)[:, :2].T), tip_mm[:, 2])), atol=1e-9
    )


@pytest.mark.parametrize("name", known_arms())
def test_what_comes_down_to_the_paper_is_the_pen(name: str) -> None:
    arm = load_arm(name)
    model = ArmModel(arm)
    joints = arm.complete(model.configuration_map().home[None])
    nodes_mm = arm_nodes(arm, joints)[0]
    last = nodes_mm[-1] - nodes_mm[-2]
    frame = arm.paper.T_paper_base @ chain_frames(arm, joints)[0, -1]
    np.testing.assert_allclose(last / np.linalg.norm(last), frame[:3, :3] @ arm.pen.tool_axis, atol=1e-6)
    assert len(link_thicknesses_mm(arm)) == len(nodes_mm) - 1


def test_links_are_as_thick_as_the_file_says_of_their_joints() -> None:
    arm = load_arm("so101")
    thick = replace(arm, joints=tuple(replace(joint, thickness_mm=10.0 + k) for k, joint in enumerate(arm.joints)))
    assert link_thicknesses_mm(thick) == [10.0, 10.0, 11.0, 12.0, 13.0, 14.0, 14.0]


@given(speed=st.floats(0.1, 50), fps=st.floats(1, 50), begin_s=st.floats(0, 2.5))
def test_frames_are_even_and_end_with_the_part(
    make_motion: Callable[..., Motion], speed: float, fps: float, begin_s: float
) -> None:
    times_s = make_motion(speed_factor=speed, fps=fps, from_s=begin_s).times_s
    assert (times_s[0], times_s[-1]) == (begin_s, 3.0)
    steps = np.diff(times_s)
    np.testing.assert_allclose(steps[:-1], speed / fps, rtol=1e-9)
    assert np.all((steps > 0) & (steps <= speed / fps * (1 + 1e-9)))


def test_a_long_film_is_sped_up_unless_told_otherwise(arm: Arm, make_trajectory: Callable[..., Trajectory]) -> None:
    long = make_trajectory(n_samples=20_001)
    tip_mm = np.zeros((20_001, 3))
    assert motion_of(long, arm, tip_mm).speed_factor == pytest.approx(10)
    assert motion_of(long, arm, tip_mm, to_s=5.0).speed_factor == 1
    with pytest.raises(UsageError, match="--speed-factor"):
        motion_of(long, arm, tip_mm, speed_factor=0.01, fps=50)


def test_pen_lines_keep_every_stroke_and_tap(make_motion: Callable[..., Motion]) -> None:
    motion = make_motion()
    trajectory, tip_mm = motion.trajectory, motion.tip_mm
    samples, begins = motion.pen_lines(10_000)
    assert set(trajectory.stroke[samples]) == {0, 1, 2}
    np.testing.assert_array_equal(samples[begins == 1], [np.flatnonzero(trajectory.stroke == k)[0] for k in range(3)])
    for stroke in (0, 2):
        kept, whole = (
            tip_mm[chosen, :2]
            for chosen in (samples[trajectory.stroke[samples] == stroke], trajectory.stroke == stroke)
        )
        np.testing.assert_array_equal(kept[[0, -1]], whole[[0, -1]])
        gaps = np.linalg.norm(whole[:, np.newaxis] - kept, axis=2).min(axis=1)
        assert gaps.max() < 0.05
    few, few_begins = motion.pen_lines(20)
    assert set(few) <= set(samples) | set(np.flatnonzero(trajectory.pen)) and len(few) <= 20 + 2 * 3
    np.testing.assert_array_equal(few[few_begins == 1], samples[begins == 1])


def test_each_pen_inks_a_film_in_its_own_colour(make_motion: Callable[..., Motion]) -> None:
    motion = make_motion(speed_factor=1.0, fps=5.0)
    pens = (PenInk("red", (255, 0, 0), 1.0), PenInk("green", (0, 255, 0), 1.0))
    change = int(np.flatnonzero(motion.trajectory.stroke == 1)[0]) - 1
    motion = replace(motion, trajectory=replace(motion.trajectory, pens=pens, pen_changes=(change,)))
    first, *_, last = [frame.astype(int) for frame in Film(motion, None, (33.0, 149.0), Look.of(dpi=60)).frames()]
    for channel, other in ((0, 1), (1, 0)):
        inked = [int((frame[..., channel] - frame[..., other] > 200).sum()) for frame in (first, last)]
        assert inked[1] > inked[0] + 10


def test_a_frame_has_the_arm_and_only_what_is_drawn_by_then(make_motion: Callable[..., Motion]) -> None:
    motion = make_motion(speed_factor=1.0, fps=5.0)
    inked = replace(motion.trajectory, pens=(PenInk("red", (255, 0, 0), 1.0),))
    motion = replace(motion, trajectory=inked)
    look = Look.of(dpi=60)
    frames = list(Film(motion, None, (33.0, 149.0), look).frames())
    assert len(frames) == 16
    height, width = frames[0].shape[:2]
    assert (width, height % 2) == (768, 0)
    assert all(frame.shape == frames[0].shape for frame in frames)

    def red(frame: FloatArray) -> int:
        return int((frame[..., 0].astype(int) - frame[..., 1] > 150).sum())

    amounts = [red(frame) for frame in frames]
    drawn_by_then = motion.last_samples(motion.times_s) >= int(np.argmax(motion.trajectory.pen))
    assert max(np.array(amounts)[~drawn_by_then]) < min(np.array(amounts)[drawn_by_then][2:])
    assert amounts[-1] > amounts[0] + 20
    assert all(np.any(one != other) for one, other in pairwise(frames))


def test_a_gif_has_the_frames_and_the_length(make_motion: Callable[..., Motion], tmp_path: Path) -> None:
    target = tmp_path / "film.GIF"
    told: list[tuple[int, int]] = []
    save_film(make_motion(fps=7.0), target, None, None, SMALL, lambda label, done, total: told.append((done, total)))
    assert target.read_bytes()[:6] == b"GIF89a"
    with Image.open(target) as film:
        lasts_ms = 0
        for frame in range(film.n_frames):
            film.seek(frame)
            lasts_ms += film.info["duration"]
        assert film.n_frames == 22
        assert lasts_ms == pytest.approx(22 / 7 * 1000, abs=5)
        assert film.size[0] == 384
        assert film.info["loop"] == 0
    assert told == [(k, 22) for k in range(22)]
    assert list(tmp_path.iterdir()) == [target]


def test_an_mp4_is_one(make_motion: Callable[..., Motion], tmp_path: Path) -> None:
    target = tmp_path / "film.mp4"
    save_film(make_motion(fps=4.0), target, look=SMALL)
    assert target.read_bytes()[4:8] == b"ftyp"
    assert list(tmp_path.iterdir()) == [target]


def test_without_ffmpeg_the_extra_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(UsageError, match=r"drawing-arm-planner\[film\]"):
        film_format(Path("film.mp4"))
    assert film_format(Path("film.gif")) == "gif"


def test_a_failing_encoder_leaves_nothing_and_says_why(
    make_motion: Callable[..., Motion], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    encoder = tmp_path / "bin" / "ffmpeg"
    encoder.parent.mkdir()
    encoder.write_text("#!/bin/sh\necho no such codec >&2\nexit 1\n")
    encoder.chmod(0o755)
    monkeypatch.setenv("PATH", str(encoder.parent), prepend=":")
    target = tmp_path / "out" / "film.mp4"
    target.parent.mkdir()
    with pytest.raises(OutputError, match="ffmpeg failed: no such codec"):
        save_film(make_motion(fps=4.0), target, look=SMALL)
    assert list(target.parent.iterdir()) == []


def test_another_suffix_is_refused_naming_those_that_work() -> None:
    for name in ("film.avi", "film"):
        with pytest.raises(UsageError, match=r"\.html, \.gif, \.mp4"):
            film_format(Path(name))


class _Page(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text: dict[str, str] = {}

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        if self.tags:
            self.text[self.tags[-1][0]] = self.text.get(self.tags[-1][0], "") + data


@pytest.mark.parametrize("theme", list(Theme))
def test_a_page_needs_nothing_but_itself(make_motion: Callable[..., Motion], tmp_path: Path, theme: Theme) -> None:
    name = "</script><b>$FILM & co"
    target = tmp_path / "film.html"
    motion = make_motion(drawing=name)
    save_film(motion, target, np.array([[120.0, 60], [120, -60], [40, -60], [40, 60]]), (33.0, 149.0), Look.of(theme))
    text = target.read_text(encoding="utf-8")
    assert not re.search(r"https?:|//[a-z]|url\(|@import|\bimport\b|fetch\(|XMLHttp|<link|<iframe", text, re.IGNORECASE)
    page = _Page()
    page.feed(text)
    assert not any({"src", "href", "srcset", "data"} & set(attributes) for _, attributes in page.tags)
    assert "default-src 'none'" in str(dict(page.tags)["meta"] | {"all": text[:600]})
    assert page.text["title"].startswith("</script><b>")
    film = json.loads(re.search(r"const film = unpacked\((\{.*\})\);\n", page.text["script"])[1])  # type: ignore[index]
    assert film["name"] == name
    poses = np.frombuffer(base64.b64decode(film["poses"]), "<i2").reshape(-1, film["nodes"], 3) * film["scale"]
    np.testing.assert_allclose(poses, motion.nodes_mm(motion.trajectory.times_s), atol=film["scale"])
    samples = np.frombuffer(base64.b64decode(film["samples"]), "<u4")
    line = np.frombuffer(base64.b64decode(film["line"]), "<i2").reshape(-1, 2) * film["scale"]
    np.testing.assert_array_equal(samples, motion.pen_lines(100_000)[0])
    np.testing.assert_allclose(line, motion.tip_mm[samples, :2], atol=film["scale"])
    assert len(np.frombuffer(base64.b64decode(film["begins"]), "u1")) == len(samples)
    assert film["colours"][0]["surface"] == Look.of(theme).colours.surface


def test_a_page_of_a_long_motion_stays_small(arm: Arm, make_trajectory: Callable[..., Trajectory]) -> None:
    long = make_trajectory(n_samples=100_001)
    motion = motion_of(long, arm, chain_poses(arm, arm.from_file_units(long.positions)).tip_mm.T)
    assert len(player_page(motion)) < 2_000_000
