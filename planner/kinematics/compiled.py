"""CasADi functions over the rows of NumPy arrays, through CasADi's raw buffers."""

from __future__ import annotations

from collections.abc import Sequence

import casadi
import numpy as np

from planner.arrays import FloatArray

_BLOCKS = (256, 16)


class CompiledFunction:
    """A symbolic function of several inputs, evaluated for many points at once.

    Inputs are (n, k_i) arrays, outputs (n, *shape_i) arrays. The function is mapped over blocks of fixed sizes, so
    nothing is copied or looked up per point: over large ones, and over small ones for the rest. A block of 1 suits
    iterations that wait for each result.
    """

    def __init__(
        self, name: str, inputs: Sequence[casadi.SX], outputs: Sequence[casadi.SX], blocks: Sequence[int] = _BLOCKS
    ) -> None:
        dense = [casadi.densify(casadi.vec(output.T)) for output in outputs]  # row-major, as NumPy reads it
        self._shapes = [tuple(output.shape) if output.shape[1] > 1 else (output.shape[0],) for output in outputs]
        self._widths = [output.numel() for output in dense]
        function = casadi.Function(name, [casadi.vec(value) for value in inputs], dense)
        self._blocks = [_Block(function, size) for size in blocks]

    def __call__(self, *inputs: FloatArray) -> list[FloatArray]:
        n_points = len(inputs[0])
        outputs = [np.empty((n_points, width)) for width in self._widths]
        start = 0
        for block in self._blocks:
            is_last = block is self._blocks[-1]
            while n_points - start >= (1 if is_last else block.size):
                block.evaluate(inputs, outputs, slice(start, min(start + block.size, n_points)))
                start += block.size
        return [output.reshape(n_points, *shape) for output, shape in zip(outputs, self._shapes, strict=True)]


class _Block:
    """The function mapped over so many points, with the arrays that it reads and writes."""

    def __init__(self, function: casadi.Function, size: int) -> None:
        self.size = size
        self._buffer, self._evaluate = function.map(size).buffer()
        self._arguments = [np.zeros((size, function.numel_in(index))) for index in range(function.n_in())]
        self._results = [np.zeros((size, function.numel_out(index))) for index in range(function.n_out())]
        for index, array in enumerate(self._arguments):
            self._buffer.set_arg(index, memoryview(array))  # type: ignore[call-arg, arg-type]
        for index, array in enumerate(self._results):
            self._buffer.set_res(index, memoryview(array))  # type: ignore[call-arg, arg-type]

    def evaluate(self, inputs: Sequence[FloatArray], outputs: Sequence[FloatArray], rows: slice) -> None:
        """Those rows of the outputs from those of the inputs, no more than the block's size."""
        count = rows.stop - rows.start
        for argument, values in zip(self._arguments, inputs, strict=True):
            argument[:count] = values[rows]
        self._evaluate()
        for output, result in zip(outputs, self._results, strict=True):
            output[rows] = result[:count]
