"""The stubs of the core are what the core has; the package exports what it says."""

import ast
import inspect
import pathlib
import subprocess
import sys

import pytest

import burgeon as bg
from burgeon import _burgeon

STUB = pathlib.Path(bg.__file__).with_name("_burgeon.pyi")


def names(function):
    """Names of parameters, and which may be left out."""
    args = function.args
    assert not (args.vararg or args.kwarg or args.kwonlyargs)
    plain = [a.arg for a in args.args if a.arg != "self"]
    return plain, plain[len(plain) - len(args.defaults) :] if args.defaults else []


def told(thing):
    """The same of a function of the core."""
    own = [p for p in inspect.signature(thing).parameters.values() if p.name not in ("self", "cls")]
    return [p.name for p in own], [p.name for p in own if p.default is not p.empty]


def decorated(function, word):
    return any(isinstance(d, ast.Name) and d.id == word for d in function.decorator_list)


def test_stubs_are_in_step_with_the_core():
    stub = ast.parse(STUB.read_text())
    said = set()
    for node in stub.body:
        if isinstance(node, ast.FunctionDef):
            said.add(node.name)
            assert names(node) == told(getattr(_burgeon, node.name)), node.name
        elif isinstance(node, ast.AnnAssign):
            said.add(node.target.id)
            assert hasattr(_burgeon, node.target.id)
        elif isinstance(node, ast.ClassDef):
            said.add(node.name)
            own, there = getattr(_burgeon, node.name), set()
            for method in node.body:
                if not isinstance(method, ast.FunctionDef):
                    continue
                there.add(method.name)
                if method.name == "__init__":
                    assert names(method) == told(own), node.name
                elif decorated(method, "property"):
                    assert not callable(getattr(own, method.name)), method.name
                else:
                    assert names(method) == told(getattr(own, method.name)), f"{node.name}.{method.name}"
            shown = {n for n in vars(own) if not n.startswith("__")} | ({"__array_interface__"} & set(vars(own)))
            assert shown == there - {"__init__"}, node.name
    assert said == {n for n in dir(_burgeon) if not n.startswith("_")}


def test_all_that_is_exported_is_there_and_documented():
    for name in bg.__all__:
        thing = getattr(bg, name)
        if inspect.isfunction(thing) or inspect.isclass(thing):
            assert inspect.getdoc(thing), name
        if inspect.isclass(thing) and thing.__module__.startswith("burgeon") and not issubclass(thing, Exception):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    assert inspect.getdoc(value), f"{name}.{member}"


@pytest.mark.parametrize("name", [n for n in bg.__all__ if inspect.isfunction(getattr(bg, n))])
def test_functions_are_annotated(name):
    thing = getattr(bg, name)
    assert "return" in thing.__annotations__ and set(inspect.signature(thing).parameters) <= set(thing.__annotations__), name


@pytest.mark.parametrize("how", [("--ignore-missing-imports", "-p", "burgeon"), ("--strict", "typed.py")])
def test_types_are_those_of_the_docs(how, tmp_path):
    """A checker of types finds nothing in the package, and in a program what is wrong (`typed.py`) and nothing else."""
    pytest.importorskip("mypy")
    words = [sys.executable, "-m", "mypy", "--cache-dir", tmp_path, *how]
    done = subprocess.run(words, cwd=pathlib.Path(__file__).parent, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
