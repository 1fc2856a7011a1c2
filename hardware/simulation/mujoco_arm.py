"""The arm of a file in MuJoCo: its links as capsules, its joints driven by position servos; and a film of it drawing.

The doorway to MuJoCo, which comes with the extra `mujoco`.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from hardware.clock import Clock
from hardware.simulation.ink import is_drawing
from hardware.simulation.simulated_arm import Recorder, Recording
from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray
from planner.errors import HardwareError, UsageError

_STEP_S = 0.001
_M = 1e-3
"""MuJoCo counts in metres and kilograms."""
_GRAVITY_M_S2 = 9.81
_LINK_RADIUS_M, _LINK_KG_M3 = 0.006, 600.0
_ARMATURE = 2e-3
"""What the motors' rotors add behind their gears, kg m2 (kg for a slide): far more than the links themselves."""
_STIFF = _ARMATURE * 150.0**2
"""A servo's natural frequency of 150 rad/s, critically damped: it follows with a lag of some 13 ms."""
_SETTLING_S = 0.3
_FILM_HZ = 10
_WIDTH, _HEIGHT = 480, 360
_INK_M = 0.0006
_MOST_INK = 20_000


class MujocoArm:
    """A driver whose joints have mass and move as their servos pull them; with `film`, watched while it draws."""

    ahead_s = 0.0

    def __init__(self, arm: Arm, clock: Clock, film: Path | None = None) -> None:
        """Errors: UsageError where MuJoCo is not installed."""
        self._mujoco = _imported()
        self._arm, self._clock = arm, clock
        self._scale = np.array([1.0 if joint.kind is JointKind.REVOLUTE else _M for joint in arm.joints])
        self._model = self._mujoco.MjModel.from_xml_string(model_of(arm))
        self._data = self._mujoco.MjData(self._model)
        self._film_file = film
        self._film: _Film | None = None
        self._connected = False
        self._at_s = 0.0
        self._recorder = Recorder(arm.n_joints)
        self._pen_height_mm = 0.0

    @property
    def recording(self) -> Recording:
        return self._recorder.recording

    @property
    def tip_mm(self) -> FloatArray:
        """(3,) where the tip of the pen is in the paper's frame, which is the model's own."""
        tip_mm: FloatArray = self._data.site("tip").xpos / _M
        return tip_mm

    def insert(self, height_mm: float) -> None:
        """A pen whose tip sticks out so much further than the arm's file says."""
        self._pen_height_mm = height_mm

    def open(self) -> None:
        """There is no line, but a film begins. Errors: HardwareError where there are no graphics for it."""
        if self._film is None and self._film_file is not None:
            self._film = _Film(self._mujoco, self._model, self._film_file)

    def connect(self, pose: FloatArray) -> None:
        self.open()
        self._data.qpos[:] = self._data.ctrl[:] = pose * self._scale
        self._mujoco.mj_forward(self._model, self._data)
        self._at_s = self._clock.now_s()
        self._connected = True

    def send(self, positions: FloatArray, duration_s: float) -> None:
        if not self._connected:
            raise HardwareError("the arm in MuJoCo is not connected")
        self._run()
        self._data.ctrl[:] = positions * self._scale
        self._record()

    def executed(self) -> int:
        return len(self._recorder)

    def flush(self) -> None:
        self._clock.sleep_until(self._clock.now_s() + _SETTLING_S)
        self._run()
        self._record()

    def emergency_stop(self) -> None:
        if self._connected:
            self._run()
            self._data.ctrl[:] = self._data.qpos

    def close(self) -> None:
        """The film is complete with this."""
        self._connected = False
        if self._film is not None:
            self._film.close()
            self._film = None

    def statistics(self) -> list[str]:
        return []

    def _run(self) -> None:
        """Let the model's time catch up with the clock's."""
        now_s = self._clock.now_s()
        while self._at_s < now_s - _STEP_S / 2:
            self._mujoco.mj_step(self._model, self._data)
            self._at_s += _STEP_S
            if self._film is not None:
                height_mm = self.tip_mm[2:] - self._pen_height_mm
                self._film.watch(self._data, drawing=bool(is_drawing(self._arm, height_mm)[0]))

    def _record(self) -> None:
        self._recorder.add(self._at_s, self._data.ctrl / self._scale, self._data.qpos / self._scale)


def model_of(arm: Arm) -> str:
    """MJCF of the chain, in the frame of the paper; the base stands upright. Row (theta, d, a, alpha) is a body at the
    joint's origin beyond the end of the row before, turned by theta, whose joint turns about z or slides along it; its
    links go d along z, then a along x, then on to the next joint's origin. Joints are driven by position."""
    root = ElementTree.Element("mujoco", model=arm.name)
    ElementTree.SubElement(root, "compiler", angle="radian", autolimits="true")
    T_paper_base = arm.paper.T_paper_base
    ElementTree.SubElement(
        root,
        "option",
        timestep=f"{_STEP_S}",
        integrator="implicitfast",
        gravity=_spaced(-_GRAVITY_M_S2 * T_paper_base[:3, 2]),
    )
    visual = ElementTree.SubElement(root, "visual")
    ElementTree.SubElement(visual, "global", offwidth=str(_WIDTH), offheight=str(_HEIGHT))
    ElementTree.SubElement(visual, "map", znear="0.01")
    ElementTree.SubElement(visual, "quality", shadowsize="0", offsamples="1")  # rendered without a graphics card
    world = ElementTree.SubElement(root, "worldbody")
    ElementTree.SubElement(world, "light", pos="0.1 0.2 0.6", dir="0 -0.3 -1", castshadow="false")
    ElementTree.SubElement(
        world, "geom", type="plane", size="0.4 0.4 0.01", rgba="0.96 0.95 0.92 1", contype="0", conaffinity="0"
    )
    actuators = ElementTree.SubElement(root, "actuator")
    parent = ElementTree.SubElement(world, "body", _placed(T_paper_base))
    end = np.eye(4)
    for joint in arm.joints:
        slides = joint.kind is JointKind.PRISMATIC
        start = end @ joint.origin.matrix
        _link(parent, end[:3, 3], start[:3, 3])
        body = ElementTree.SubElement(parent, "body", _placed(start @ _dh_matrix(joint.theta_rad, 0.0, 0.0, 0.0)))
        low, high = (limit * (_M if slides else 1.0) for limit in (joint.minimum, joint.maximum))
        ElementTree.SubElement(
            body,
            "joint",
            name=joint.name,
            type="slide" if slides else "hinge",
            axis="0 0 1",
            range=f"{low:.9g} {high:.9g}",
            armature=f"{_ARMATURE}",
        )
        ElementTree.SubElement(actuators, "position", joint=joint.name, kp=f"{_STIFF}", dampratio="1")
        end = _dh_matrix(0.0, joint.d_mm, joint.a_mm, joint.alpha_rad)
        bend = np.array([0.0, 0.0, joint.d_mm])
        _link(body, np.zeros(3), bend)
        _link(body, bend, end[:3, 3])
        # A joint that no link goes out from would have no mass at all.
        ElementTree.SubElement(
            body,
            "geom",
            type="sphere",
            size=f"{_LINK_RADIUS_M * 1.3}",
            contype="0",
            conaffinity="0",
            density=f"{_LINK_KG_M3}",
            rgba="0.25 0.25 0.28 1",
        )
        parent = body
    tip = end @ arm.tool.matrix
    _link(parent, end[:3, 3], tip[:3, 3])
    ElementTree.SubElement(parent, "site", name="tip", pos=_spaced(tip[:3, 3] * _M), size="0.001")
    return ElementTree.tostring(root, encoding="unicode")


def _spaced(values: FloatArray) -> str:
    return " ".join(f"{value:.12g}" for value in values.tolist())


def _placed(frame: FloatArray) -> dict[str, str]:
    """Attributes of a body whose frame is this (4, 4) in its parent's, mm."""
    return {"pos": _spaced(frame[:3, 3] * _M), "xyaxes": _spaced(np.concatenate((frame[:3, 0], frame[:3, 1])))}


def _link(body: ElementTree.Element, begin_mm: FloatArray, end_mm: FloatArray) -> None:
    """A capsule between two points (3,) of the body's frame, unless they are the same."""
    if (begin_mm == end_mm).all():
        return
    ElementTree.SubElement(
        body,
        "geom",
        type="capsule",
        size=f"{_LINK_RADIUS_M}",
        density=f"{_LINK_KG_M3}",
        contype="0",
        conaffinity="0",
        rgba="0.2 0.45 0.7 1",
        fromto=_spaced(np.concatenate((begin_mm, end_mm)) * _M),
    )


def _dh_matrix(theta_rad: float, d_mm: float, a_mm: float, alpha_rad: float) -> FloatArray:
    """(4, 4) Rz(theta) Tz(d) Tx(a) Rx(alpha), mm."""
    c, s, ca, sa = np.cos(theta_rad), np.sin(theta_rad), np.cos(alpha_rad), np.sin(alpha_rad)
    return np.array(
        [[c, -s * ca, s * sa, a_mm * c], [s, c * ca, -c * sa, a_mm * s], [0.0, sa, ca, d_mm], [0.0, 0.0, 0.0, 1.0]]
    )


class _Film:
    """Frames of the model and of the ink that it leaves, to a .gif or .mp4."""

    def __init__(self, mujoco: Any, model: Any, target: Path) -> None:
        import imageio.v2 as imageio

        self._mujoco = mujoco
        try:
            self._renderer = mujoco.Renderer(model, _HEIGHT, _WIDTH, max_geom=_MOST_INK + 200)
        except Exception as error:  # whatever the graphics library of this computer raises
            raise HardwareError(
                f"no film: MuJoCo finds no graphics here ({error}); --film needs EGL, such as Debian's "
                "libegl1 and libegl-mesa0"
            ) from error
        self._camera = mujoco.MjvCamera()
        self._camera.lookat[:] = (0.08, 0.0, 0.02)
        self._camera.distance, self._camera.azimuth, self._camera.elevation = 0.45, 155.0, -35.0
        options = {"duration": 1000 / _FILM_HZ} if target.suffix.lower() == ".gif" else {"fps": _FILM_HZ}
        self._writer = imageio.get_writer(target, **options)
        self._ink: list[tuple[FloatArray, FloatArray]] = []
        self._pen: FloatArray | None = None
        self._next_s = 0.0

    def watch(self, data: Any, *, drawing: bool) -> None:
        tip = data.site("tip").xpos.copy()
        if not drawing:
            self._pen = None
        elif self._pen is None:
            self._pen = tip
        elif np.linalg.norm(tip - self._pen) > _INK_M:
            self._ink.append((self._pen, tip))
            self._pen = tip
        if data.time < self._next_s:
            return
        self._next_s += 1 / _FILM_HZ
        self._renderer.update_scene(data, self._camera)
        scene = self._renderer.scene
        for begin, end in self._ink[:_MOST_INK]:
            geom = scene.geoms[scene.ngeom]
            self._mujoco.mjv_initGeom(
                geom,
                self._mujoco.mjtGeom.mjGEOM_CAPSULE,
                np.zeros(3),
                np.zeros(3),
                np.zeros(9),
                np.array([0.1, 0.1, 0.5, 1.0], dtype=np.float32),
            )
            self._mujoco.mjv_connector(geom, self._mujoco.mjtGeom.mjGEOM_CAPSULE, _INK_M / 2, begin, end)
            scene.ngeom += 1
        self._writer.append_data(self._renderer.render())

    def close(self) -> None:
        self._writer.close()
        self._renderer.close()


def _imported() -> Any:
    if sys.platform == "linux":
        os.environ.setdefault("MUJOCO_GL", "egl")  # films are made without a screen
    try:
        import mujoco
    except ImportError as error:
        raise UsageError(
            "driver mujoco needs the extra of that name: pip install 'drawing-arm-planner[mujoco]'"
        ) from error
    return mujoco
