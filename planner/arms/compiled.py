"""CasADi functions over the rows of NumPy arrays, through CasADi's raw buffers."""

from __future__ import annotations

from collections.abc import Sequence

import casadi
import numpy as np

from planner.arrays import FloatArray

_BLOCK = 256


class CompiledFunction:
    """A symbolic function of several inputs, evaluated for many points at once.

    Inputs are (n, k_i) arrays, outputs (n, *shape_i) arrays. The function is mapped over blocks of a
    fixed size, so nothing is copied or looked up per point; a block of 1 suits iterations that wait for
    each result.
    """

    def __init__(self, name: str, inputs: Sequence[casadi.SX], outputs: Sequence[casadi.SX],
                 block: int = _BLOCK) -> None:
        dense = [casadi.densify(casadi.vec(output.T)) for output in outputs]  # row-major, as NumPy reads it
        self._block = block
        self._shapes = [tuple(output.shape) if output.shape[1] > 1 else (output.shape[0],) for output in outputs]
        function = casadi.Function(name, [casadi.vec(value) for value in inputs], dense)
        self._buffer, self._evaluate = function.map(block).buffer()
        self._arguments = [np.zeros((block, value.numel())) for value in inputs]
        self._results = [np.zeros((block, value.numel())) for value in dense]
        for index, array in enumerate(self._arguments):
            self._buffer.set_arg(index, memoryview(array))  # type: ignore[call-arg, arg-type]
        for index, array in enumerate(self._results):
            self._buffer.set_res(index, memoryview(array))  # type: ignore[call-arg, arg-type]

    def __call__(self, *inputs: FloatArray) -> list[FloatArray]:
        n_points = len(inputs[0])
        outputs = [np.empty((n_points, array.shape[1])) for array in self._results]
        for start in range(0, n_points, self._block):
            count = min(self._block, n_points - start)
            for argument, values in zip(self._arguments, inputs, strict=True):
                argument[:count] = values[start:start + count]
            self._evaluate()
            for output, result in zip(outputs, self._results, strict=True):
                output[start:start + count] = result[:count]
        return [output.reshape(n_points, *shape) for output, shape in zip(outputs, self._shapes, strict=True)]
