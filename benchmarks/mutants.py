"""Mutation score of the tests: small faults in ten modules, one at a time, and which of them no test of theirs finds.

    python benchmarks/mutants.py                                        # 40 of each module's mutants: about an hour
    python benchmarks/mutants.py planner/motion/speed_limit.py --most 0  # all of one module's

Every comparison, sum, product, number, condition and choice of the larger or smaller is a place for a fault. A mutant
is made in a copy of the tree, never in the tree itself, and killed by a test that fails, or that takes far longer
than before. Some survivors do what the module did: to tell them from faults that the tests miss takes a look.
"""

from __future__ import annotations

import argparse
import ast
import copy
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TESTS = {
    "planner/spline.py": ["tests/test_spline.py"],
    "planner/drawing/tour.py": ["tests/drawing/test_tour_lengths.py", "tests/drawing/test_join_and_order.py"],
    "planner/drawing/order.py": ["tests/drawing/test_tour_lengths.py", "tests/drawing/test_join_and_order.py"],
    "planner/drawing/join.py": ["tests/drawing/test_join_and_order.py"],
    "planner/drawing/flatten.py": ["tests/drawing/test_flatten.py"],
    "planner/placement/fit.py": ["tests/placement/test_fit.py"],
    "planner/placement/pieces.py": ["tests/placement/test_pieces.py"],
    "planner/motion/speed_limit.py": ["tests/motion/test_speed_limit.py"],
    "planner/motion/chord_error_limit.py": ["tests/motion/test_chord_error_limit.py"],
    "planner/travel/travel_choice.py": ["tests/travel/test_travel_choice.py"],
    "hardware/motion/stopping.py": ["tests/hardware/motion/test_stopping.py"],
    "hardware/playback/journal_entry.py": ["tests/hardware/playback/test_journal.py"],
}
_COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
}
_OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
}
_OTHERS = {
    name: other
    for one, two in (("min", "max"), ("minimum", "maximum"), ("argmin", "argmax"), ("ceil", "floor"), ("any", "all"))
    for name, other in ((one, two), (two, one))
}


def faults(node: ast.AST) -> Iterator[Callable[[ast.AST], None]]:
    """What may go wrong at one place of the syntax tree: changes of the node in place."""
    match node:
        case ast.Compare(ops=[only]) if type(only) in _COMPARISONS:
            yield lambda at: at.ops.__setitem__(0, _COMPARISONS[type(at.ops[0])]())
        case ast.BinOp(op=operator) if type(operator) in _OPERATORS:
            yield lambda at: setattr(at, "op", _OPERATORS[type(at.op)]())
        case ast.AugAssign(op=operator) if type(operator) in _OPERATORS:
            yield lambda at: setattr(at, "op", _OPERATORS[type(at.op)]())
        case ast.BoolOp():
            yield lambda at: setattr(at, "op", ast.Or() if isinstance(at.op, ast.And) else ast.And())
        case ast.Constant(value=bool()):
            yield lambda at: setattr(at, "value", not at.value)
        case ast.Constant(value=int() | float()):
            yield lambda at: setattr(at, "value", at.value + 1 if isinstance(at.value, int) else at.value * 1.2 + 1e-9)
        case ast.Name(id=name) if name in _OTHERS:
            yield lambda at: setattr(at, "id", _OTHERS[at.id])
        case ast.Attribute(attr=name) if name in _OTHERS:
            yield lambda at: setattr(at, "attr", _OTHERS[at.attr])
        case ast.If() | ast.While():
            yield lambda at: setattr(at, "test", ast.UnaryOp(ast.Not(), at.test))


def mutants(source: str) -> Iterator[tuple[int, str, str]]:
    """The line of each fault, that line as it becomes, and the whole module with it."""
    tree = ast.parse(source)
    texts = {id(inner) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for inner in ast.walk(node)}
    notes = {
        id(inner)
        for node in ast.walk(tree)
        for note in (getattr(node, "annotation", None), getattr(node, "returns", None))
        if note is not None
        for inner in ast.walk(note)
    }
    for index, node in enumerate(ast.walk(tree)):
        if id(node) in texts | notes:
            continue
        for change in faults(node):
            mutated = copy.deepcopy(tree)
            at = next(inner for place, inner in enumerate(ast.walk(mutated)) if place == index)
            change(at)
            yield node.lineno, ast.unparse(ast.fix_missing_locations(at)).splitlines()[0], ast.unparse(mutated)


def survives(folder: Path, tests: list[str], longest_s: float) -> bool:
    try:
        ran = subprocess.run(
            [sys.executable, "-m", "pytest", "-n", "0", "-x", "-q", "-p", "no:cacheprovider", *tests],
            cwd=folder,
            env=os.environ | {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"},
            capture_output=True,
            timeout=longest_s,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return False
    return ran.returncode == 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("modules", nargs="*", default=list(TESTS), metavar="MODULE", help=", ".join(TESTS))
    parser.add_argument("--most", type=int, default=40, help="mutants of a module, drawn at random; 0 for all")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name, "tree")
        for part in ("planner", "hardware", "tests", "configs", "examples", "pyproject.toml"):
            copied = shutil.copytree if (ROOT / part).is_dir() else shutil.copy2
            folder.mkdir(exist_ok=True)
            copied(ROOT / part, folder / part)
        for module in options.modules:
            source = (ROOT / module).read_text(encoding="utf-8")
            began = time.perf_counter()
            if not survives(folder, TESTS[module], 600.0):
                print(f"{module}: its tests fail without any fault")
                return 1
            longest_s = 20.0 + 5.0 * (time.perf_counter() - began)
            all_of_it = list(mutants(source))
            drawn = (
                all_of_it
                if not options.most
                else random.Random(options.seed).sample(all_of_it, min(options.most, len(all_of_it)))  # noqa: S311
            )
            survivors = 0
            for line, changed, mutated in sorted(drawn):
                (folder / module).write_text(mutated, encoding="utf-8")
                if survives(folder, TESTS[module], longest_s):
                    survivors += 1
                    print(f"{module}:{line}: {changed}", flush=True)
            (folder / module).write_text(source, encoding="utf-8")
            print(
                f"{module}: {len(drawn) - survivors} of {len(drawn)} killed, of {len(all_of_it)} there are", flush=True
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
