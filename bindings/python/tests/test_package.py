"""Stubs, names and documentation of the package."""
import doctest
import inspect
import pathlib
import re

import numpy as np
import pytest
from conftest import ROOT

import aspic
from aspic import _aspic, _cpu


def test_stubs_list_the_names_of_the_module():
    stub = pathlib.Path(aspic.__file__).with_name("_aspic.pyi").read_text()
    top = set(re.findall(r"^(?:class|def) (\w+)", stub, re.M))
    of_fits = {"Equilibrium", "Trajectory", "capture", "fit"}  # of the package inverse, as a whole
    absent = of_fits if not hasattr(_aspic, "fit") else set()
    assert top - absent == {name for name in dir(_aspic) if not name.startswith("__")}
    for name, body in re.findall(r"^class (\w+).*?:\n((?:    .*\n)+)", stub, re.M):
        if name in absent:
            continue
        listed = set(re.findall(r"def (\w+)", body)) - {"__init__", "__call__", "__matmul__"}
        members = {member for member in vars(getattr(_aspic, name)) if not member.startswith("_")}
        assert listed == members, name


def public_callables():
    """Names and values of the functions of the package, and of the methods and properties of its classes."""
    for name in aspic.__all__:
        thing = getattr(aspic, name)
        if not getattr(thing, "__module__", "").startswith("aspic."):
            continue
        if not inspect.isclass(thing):
            yield name, thing
        elif not issubclass(thing, aspic.Energy):
            yield name, thing
            for member, value in vars(thing).items():
                value = value.fget if isinstance(value, property) else getattr(value, "__func__", value)
                if not member.startswith("_") and callable(value):
                    yield f"{name}.{member}", value


def test_public_names_have_docstrings_and_types():
    for name, value in public_callables():
        assert inspect.getdoc(value), name
        if inspect.isfunction(value):  # others are typed by the stub
            assert "return" in value.__annotations__, name


def test_old_processor_is_refused_in_words(tmp_path):
    (tmp_path / "cpuinfo").write_text("processor : 0\nflags : fpu sse4_2 avx\n")
    with pytest.raises(ImportError, match="x86-64-v3 processor.*avx2"):
        _cpu.require_processor(tmp_path / "cpuinfo")
    _cpu.require_processor()


def test_documentation_names_what_exists():
    text = (ROOT / "docs/python.md").read_text()
    for name in set(re.findall(r"aspic\.(\w+)", text)):
        folder = pathlib.Path(aspic.__file__).parent
        assert hasattr(aspic, name) or (folder / f"{name}.py").exists() or (folder / name / "__init__.py").exists(), name
    for link in re.findall(r"\]\((?!https?:)([^)#]+)", text):
        assert (ROOT / "docs" / link).exists() or "inverse/" in link and not (ROOT / "inverse").exists(), link


def test_examples_of_docstrings_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = [test for name in aspic.__all__ for test in doctest.DocTestFinder().find(
        getattr(aspic, name), f"aspic.{name}", globs={"aspic": aspic, "np": np})]
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    messages = []
    for test in found:
        runner.run(test, out=messages.append)
    assert runner.failures == 0, "".join(messages)
    # Results of other functions, what the module provides, and what needs a data set, a display or minutes.
    without = {"Body", "Figure", "Hessian", "InvalidInput", "Iteration", "LinearSolver", "NotConverged", "Objective", "Reports",
               "Snapshot", "StepReport", "View", "__version__", "capture", "fit", "integrator_names", "linear_solver_names", "materials",
               "minimizer_names", "plot", "set_thread_count", "test_functions", "thread_count", "verify", "view"}
    assert {test.name.removeprefix("aspic.") for test in found if test.examples} >= set(aspic.__all__) - without
