"""The trajectory file: a round trip changes nothing, damage is named with its line, and a file is whole or absent."""

from __future__ import annotations

import os
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.drawing.options import ReadingOptions
from planner.errors import OutputError, TrajectoryFileError
from planner.files import written_aside
from planner.head import LeftOut, Placement
from planner.trajectory import TRAVELLING, Trajectory, read_trajectory, write_trajectory

AFFINE = (0.0, -0.25, -0.25, 0.0, 133.2, 60.1)
coordinates = st.floats(-1e6, 1e6, allow_subnormal=False)
words = st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Z", "Cs"]), max_size=12)


@st.composite
def trajectories(draw: st.DrawFn) -> Trajectory:
    units = draw(st.lists(st.sampled_from(["deg", "mm"]), min_size=1, max_size=7))
    pen = np.array(draw(st.lists(st.booleans(), min_size=1, max_size=30)))
    n = len(pen)
    begins = pen & ~np.concatenate(([False], pen[:-1]))
    stroke = np.where(pen, np.cumsum(begins) - 1, TRAVELLING)
    seed = draw(st.integers(0, 2**32 - 1))
    positions = np.random.default_rng(seed).uniform(-720, 720, (n, len(units)))
    return Trajectory(
        arm=draw(words.filter(str.strip)),
        drawing=draw(words),
        method=draw(words),
        rate_hz=draw(st.floats(0.1, 5000)),
        columns=tuple(f"j{index}_{unit}" for index, unit in enumerate(units)),
        positions=positions,
        pen=pen,
        stroke=stroke,
        svg_to_arm_mm=draw(st.tuples(*[coordinates] * 6)),
    )


def sample(n: int = 40) -> Trajectory:
    stroke = np.full(n, TRAVELLING)
    stroke[5:10], stroke[20:30] = 0, 1
    positions = np.linspace((0.0, 10.0), (30.0, -20.0), n)
    return Trajectory("two", "line.svg", "path", 100.0, ("q1_deg", "d2_mm"), positions, stroke >= 0, stroke, AFFINE)


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("trajectory") / "traj.csv"
    write_trajectory(sample(), target)
    return target


@given(trajectories())
def test_round_trip_changes_nothing(tmp_path_factory: pytest.TempPathFactory, trajectory: Trajectory) -> None:
    target = tmp_path_factory.getbasetemp() / "round_trip.csv"
    write_trajectory(trajectory, target)
    again = read_trajectory(target)
    assert (again.arm, again.drawing, again.method) == (trajectory.arm, trajectory.drawing, trajectory.method)
    assert (again.rate_hz, again.columns, again.svg_to_arm_mm) == (
        trajectory.rate_hz,
        trajectory.columns,
        trajectory.svg_to_arm_mm,
    )
    assert again.duration_s == trajectory.duration_s
    np.testing.assert_allclose(again.positions, trajectory.positions, rtol=0, atol=0.51e-9)
    np.testing.assert_array_equal(again.pen, trajectory.pen)
    np.testing.assert_array_equal(again.stroke, trajectory.stroke)


def test_written_again_the_file_is_the_same(file: Path, tmp_path: Path) -> None:
    write_trajectory(read_trajectory(file), tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == file.read_bytes()


def test_layout_is_the_documented_one(file: Path) -> None:
    lines = file.read_text(encoding="utf-8").splitlines()
    assert lines[:9] == [
        "# trajectory: 1",
        "# arm: two",
        "# drawing: line.svg",
        "# method: path",
        "# rate_hz: 100",
        "# duration_s: 0.39",
        "# svg_to_arm_mm: 0.0 -0.25 -0.25 0.0 133.2 60.1",
        "t_s,q1_deg,d2_mm,pen,stroke",
        "0.000000,0.000000000,10.000000000,0,-1",
    ]
    assert lines[9 + 4].endswith(",1,0")


def test_samples_know_their_lines(file: Path, tmp_path: Path) -> None:
    assert sample().line(0) == read_trajectory(file).line(0) == 9
    longer = tmp_path / "longer.csv"
    longer.write_text("# trajectory: 1\n# made by hand\n" + file.read_text().split("\n", 1)[1])
    assert read_trajectory(longer).line(3) == 13


@pytest.mark.parametrize(
    "change",
    [lambda text: "\ufeff" + text, lambda text: text.replace("\n", "\r\n"), lambda text: text.rstrip("\n")],
    ids=["byte order mark", "windows line ends", "no last line end"],
)
def test_editors_habits_are_no_damage(file: Path, tmp_path: Path, change) -> None:
    edited = tmp_path / "edited.csv"
    edited.write_text(change(file.read_text()), encoding="utf-8", newline="")
    np.testing.assert_array_equal(read_trajectory(edited).positions, read_trajectory(file).positions)


def edit(line: int, old: str, new: str):
    def apply(lines: list[str]) -> list[str]:
        assert old in lines[line - 1]
        return [*lines[: line - 1], lines[line - 1].replace(old, new, 1), *lines[line:]]

    return apply


DAMAGE = {
    "no first line": (lambda lines: lines[1:], 1, "does not begin"),
    "another format": (edit(1, "1", "2"), 1, "format '2'"),
    "empty": (lambda lines: [], 1, "does not begin"),
    "something else": (lambda lines: ["x,y", "1,2"], 1, "does not begin"),
    "rate not a number": (edit(5, "100", "fast"), 5, "rate_hz"),
    "rate zero": (edit(5, "100", "0"), 5, "rate_hz"),
    "rate not finite": (edit(5, "100", "inf"), 5, "rate_hz"),
    "no rate": (lambda lines: [line for line in lines if "rate_hz" not in line], None, "rate_hz"),
    "no duration": (lambda lines: [line for line in lines if "duration" not in line], None, "duration_s"),
    "five of six": (edit(7, " 60.1", ""), 7, "svg_to_arm_mm"),
    "header alone": (lambda lines: lines[:7], 7, "ends before its column names"),
    "no samples": (lambda lines: lines[:8], 8, "no samples"),
    "no pen column": (edit(8, ",pen", ""), 8, "columns"),
    "no unit": (edit(8, "q1_deg", "q1"), 8, "no unit"),
    "twice the same": (edit(8, "d2_mm", "q1_deg"), 8, "same name"),
    "a cell too many": (edit(15, "0.06", "0.06,0.06"), 15, "6 cell(s); wanted 5"),
    "a word": (edit(15, "0.060000", "soon"), 15, "'soon' is not a finite number"),
    "a cell too few": (edit(15, ",1,0", ",1"), 15, "4 cell(s); wanted 5"),
    "an empty cell": (edit(15, "0.060000,", ","), 15, "'' is not a finite number"),
    "nan": (edit(15, "0.060000", "nan"), 15, "'nan' is not a finite number"),
    "infinite": (edit(15, "0.060000", "1e999"), 15, "'1e999' is not a finite number"),
    "huge": (edit(15, "0.060000", "1e30"), 15, "beyond any"),
    "underscore": (edit(15, "0.060000", "0_0.06"), 15, "'0_0.06' is not a finite number"),
    "other digits": (edit(15, "0.060000", "٠.06"), 15, "is not a finite number"),
    "an empty line": (lambda lines: [*lines[:20], "", *lines[20:]], 21, "has 1 cell(s)"),
    "a comment in the samples": (lambda lines: [*lines[:20], "# hello", *lines[20:]], 21, "has 1 cell(s)"),
    "a line missing": (lambda lines: [*lines[:20], *lines[21:]], 21, "not on the grid"),
    "a line twice": (lambda lines: [*lines[:20], *lines[19:]], 21, "not on the grid"),
    "the end missing": (lambda lines: lines[:30], 30, "promises 0.39 s"),
    "the end cut": (lambda lines: [*lines[:29], lines[29][:9]], 30, "has 2 cell(s)"),
    "pen 2": (edit(15, ",1,0", ",2,0"), 15, "pen"),
    "stroke 0.5": (edit(15, ",1,0", ",1,0.5"), 15, "not an index"),
    "stroke -2": (edit(20, ",0,-1", ",0,-2"), 20, "not an index"),
    "down between strokes": (edit(20, ",0,-1", ",1,-1"), 20, "down between strokes"),
    "strokes backwards": (edit(31, ",1,1", ",1,0"), 31, "backwards"),
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_damage_is_named_with_its_line(file: Path, tmp_path: Path, kind: str) -> None:
    change, line, reason = DAMAGE[kind]
    damaged = tmp_path / "damaged.csv"
    damaged.write_text("".join(f"{row}\n" for row in change(file.read_text().splitlines())), encoding="utf-8")
    with pytest.raises(TrajectoryFileError) as caught:
        read_trajectory(damaged)
    assert caught.value.line == line
    assert reason in caught.value.reason
    assert "\n" not in str(caught.value)


@given(position=st.floats(0, 1), byte=st.integers(0, 255))
def test_any_changed_byte_is_read_or_refused(
    file: Path, tmp_path_factory: pytest.TempPathFactory, position: float, byte: int
) -> None:
    content = bytearray(file.read_bytes())
    content[int(position * (len(content) - 1))] = byte
    damaged = tmp_path_factory.getbasetemp() / "byte.csv"
    damaged.write_bytes(content)
    try:
        message = ""
        positions = read_trajectory(damaged).positions
    except TrajectoryFileError as error:
        message, positions = str(error), np.zeros((0, 2))
    assert message.isprintable()
    assert np.isfinite(positions).all()


@given(st.binary(max_size=200))
def test_any_bytes_are_refused(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    foreign = tmp_path_factory.getbasetemp() / "foreign.csv"
    foreign.write_bytes(content)
    with pytest.raises(TrajectoryFileError):
        read_trajectory(foreign)


HEAD = b"# trajectory: 1\n# rate_hz: 100\n# duration_s: 1\n# svg_to_arm_mm: 1 0 0 1 0 0\nt_s,q1_deg,pen,stroke\n"


@pytest.mark.parametrize("head", [b"", HEAD], ids=["from the start", "after the header"])
def test_a_line_without_end_takes_no_memory(tmp_path: Path, head: bytes) -> None:
    endless = tmp_path / "endless.csv"
    with endless.open("wb") as file:
        file.write(head)
        file.truncate(1 << 33)  # a file of holes: 8 GiB of NUL bytes that take no room
    with pytest.raises(TrajectoryFileError):
        read_trajectory(endless)


def test_missing_file_and_folder_are_refused(tmp_path: Path) -> None:
    for path in (tmp_path / "none.csv", tmp_path):
        with pytest.raises(TrajectoryFileError, match="cannot be read"):
            read_trajectory(path)


def test_what_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("")
    (tmp_path / "loop").symlink_to("loop")
    for target in ("missing/traj.csv", "folder", "file/traj.csv", "n" * 300, "loop/traj.csv"):
        with pytest.raises(OutputError) as caught:
            write_trajectory(sample(), tmp_path / target)
        assert caught.value.target == str(tmp_path / target)
        assert "\n" not in str(caught.value)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "folder", "loop"]
    assert not list((tmp_path / "folder").iterdir())


def test_a_failure_half_way_keeps_what_was_there(tmp_path: Path) -> None:
    target = tmp_path / "traj.csv"
    target.write_text("before")

    def write(failure: BaseException) -> None:
        with written_aside(target) as file:
            file.write("half a line")  # type: ignore[arg-type]
            raise failure

    with pytest.raises(OutputError, match="No space left"):
        write(OSError(28, os.strerror(28)))
    with pytest.raises(KeyboardInterrupt):
        write(KeyboardInterrupt())
    assert target.read_text() == "before"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no device that is always full")
def test_a_full_disk_is_reported(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="No space left"):
        write_trajectory(sample(), Path("/dev/full"))
    assert Path("/dev/full").is_char_device()
    link = tmp_path / "link.csv"
    link.symlink_to("/dev/full")
    with pytest.raises(OutputError, match="No space left"):
        write_trajectory(sample(), link)


@pytest.mark.skipif(os.name != "posix", reason="pipes with a name are of POSIX")
def test_a_pipe_stays_a_pipe(tmp_path: Path, file: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_trajectory(sample(), pipe)
        assert os.read(reader, 1 << 16) == file.read_bytes()
    finally:
        os.close(reader)
    assert pipe.is_fifo()


def test_links_are_followed(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    for name, goal in (("dangling.csv", "there/new.csv"), ("old.csv", "there/old.csv")):
        (tmp_path / name).symlink_to(goal)
    (tmp_path / "there" / "old.csv").write_text("before")
    for name in ("dangling.csv", "old.csv"):
        write_trajectory(sample(), tmp_path / name)
        assert (tmp_path / name).is_symlink()
        assert read_trajectory(tmp_path / name).n_samples == 40
    assert sorted(path.name for path in (tmp_path / "there").iterdir()) == ["new.csv", "old.csv"]


@pytest.mark.skipif(os.name != "posix", reason="permissions are of POSIX")
def test_permissions_are_the_usual_ones(tmp_path: Path) -> None:
    target = tmp_path / "traj.csv"
    before = os.umask(0o027)
    try:
        write_trajectory(sample(), target)
        assert target.stat().st_mode & 0o777 == 0o640
        target.chmod(0o600)
        write_trajectory(sample(), target)
        assert target.stat().st_mode & 0o777 == 0o600
    finally:
        os.umask(before)


def test_file_names_that_are_no_unicode_do_not_matter(tmp_path: Path) -> None:
    odd = sample()
    odd = Trajectory(
        odd.arm,
        "caf\udce9.svg\n# arm: other",
        odd.method,
        odd.rate_hz,
        odd.columns,
        odd.positions,
        odd.pen,
        odd.stroke,
        odd.svg_to_arm_mm,
    )
    write_trajectory(odd, tmp_path / "traj.csv")
    again = read_trajectory(tmp_path / "traj.csv")
    assert (again.arm, again.drawing) == ("two", "caf?.svg # arm: other")


def test_large_files_are_quick(tmp_path: Path) -> None:
    n = 100_000
    stroke = np.full(n, TRAVELLING)
    large = Trajectory(
        "five",
        "large.svg",
        "path",
        100.0,
        tuple(f"q{k}_deg" for k in range(5)),
        np.random.default_rng(1).uniform(-150, 150, (n, 5)),
        stroke >= 0,
        stroke,
        AFFINE,
    )
    begin = time.process_time()
    write_trajectory(large, tmp_path / "large.csv")
    again = read_trajectory(tmp_path / "large.csv")
    assert time.process_time() - begin < 2.0  # measured 0.4 s
    np.testing.assert_allclose(again.positions, large.positions, rtol=0, atol=0.51e-9)


def test_the_decimals_of_each_position_are_counted(tmp_path: Path) -> None:
    cells = {
        "1.5": 1,
        "-12.123456": 6,
        "3": 0,
        "0.123456789": 9,
        "1.25e-3": 5,
        "2.5E2": 0,
        " 7.1234567 ": 7,
        "1e-7": 7,
        "0.1234567890123456": 16,
        "+4.": 0,
    }
    file = tmp_path / "traj.csv"
    rows = [f"{index / 100:.6f},{cell},0.1234567,0,-1" for index, cell in enumerate(cells)]
    head = sample(len(rows)).head.text()
    file.write_text(f"{head}t_s,q1_deg,d2_mm,pen,stroke\n" + "\n".join(rows))
    trajectory = read_trajectory(file)
    assert trajectory.decimals is not None
    assert trajectory.decimals[:, 0].tolist() == list(cells.values())
    assert set(trajectory.decimals[:, 1].tolist()) == {7}
    wanted = [0.5 * 10.0 ** -max(count, 6) for count in cells.values()]
    np.testing.assert_allclose(trajectory.rounding[:, 0], wanted, atol=4e-13)


@given(trajectories())
def test_what_is_written_is_within_its_rounding(
    tmp_path_factory: pytest.TempPathFactory, trajectory: Trajectory
) -> None:
    target = tmp_path_factory.getbasetemp() / "rounded.csv"
    write_trajectory(trajectory, target)
    read = read_trajectory(target)
    assert np.all(np.abs(read.positions - trajectory.positions) <= read.rounding)
    assert read.rounding.max() < 1e-9
    assert trajectory.line(0) == read.line(0)


PLACED = Placement((33.0, 114.5, -93.25, 93.25), 5.0, 1.966, 17.5, mirror=True)


@pytest.mark.parametrize("placement", [Placement(), Placement(scale=2.0), Placement(margin_mm=0.0), PLACED])
@pytest.mark.parametrize("left_out", [LeftOut(), LeftOut(37.25, 2), LeftOut(0.0, 1)])
def test_the_placement_and_what_was_left_out_are_read_back(
    placement: Placement, left_out: LeftOut, tmp_path: Path
) -> None:
    written = replace(sample(), placement=placement, left_out=left_out)
    write_trajectory(written, tmp_path / "traj.csv")
    read = read_trajectory(tmp_path / "traj.csv")
    assert (read.placement, read.left_out) == (placement, left_out)
    assert read.line(3) == written.line(3)


@pytest.mark.parametrize(
    ("reading", "told"),
    [
        (ReadingOptions(), []),
        (ReadingOptions(crop="none", occlude=True, dpi=72), ["# crop: none", "# occlude: yes", "# dpi: 72"]),
        (ReadingOptions("outline", Path("a font.ttf")), ["# text: outline", "# font: a font.ttf"]),
        (ReadingOptions(text="skip"), ["# text: skip"]),
    ],
)
def test_how_the_drawing_was_read_is_told_where_it_is_not_the_usual_way(
    reading: ReadingOptions, told: list[str], tmp_path: Path
) -> None:
    write_trajectory(replace(sample(), reading=reading), tmp_path / "traj.csv")
    assert read_trajectory(tmp_path / "traj.csv").reading == reading
    lines = (tmp_path / "traj.csv").read_text().splitlines()
    assert [line for line in lines if line.startswith(("# text", "# font", "# crop", "# occlude", "# dpi"))] == told


@pytest.mark.parametrize(
    ("entry", "reason"),
    [
        ("text: loud", r"line 8: '# text:' is 'loud': text is one of single, outline, skip"),
        ("font: a.ttf", r"a font file goes with text"),
        ("crop: 1", r"line 8: '# crop:' is '1': crop is one of page, none"),
        ("occlude: perhaps", r"line 8: '# occlude:' is 'perhaps': wanted yes or no"),
        ("dpi: none", r"line 8: '# dpi:' is 'none'"),
        ("dpi: 1", r"line 8: '# dpi:' is '1': dpi 1 has to be at least 10"),
        ("canvas_mm: 1 2 3", r"line 8: '# canvas_mm:' is '1 2 3'; wanted 4 number"),
        ("margin_mm: wide", r"line 8: '# margin_mm:' is 'wide'"),
        ("scale: nan", r"line 8: '# scale:' is 'nan'"),
        ("rotate_deg:", r"line 8: '# rotate_deg:' is ''"),
        ("mirror: maybe", r"line 8: '# mirror:' is 'maybe'; wanted yes or no"),
        ("left_out_mm: -1", r"line 8: '# left_out_mm:' is -1"),
        ("left_out_taps: 1.5", r"line 8: '# left_out_taps:' is 1.5"),
    ],
)
def test_a_damaged_placement_is_named(entry: str, reason: str, tmp_path: Path) -> None:
    file = tmp_path / "traj.csv"
    write_trajectory(sample(), file)
    lines = file.read_text().splitlines()
    file.write_text("\n".join([*lines[:7], f"# {entry}", *lines[7:]]) + "\n")
    with pytest.raises(TrajectoryFileError, match=reason):
        read_trajectory(file)
