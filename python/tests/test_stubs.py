"""The types of the compiled part are those that it has."""

import ast
import os
import subprocess
import sys

import pytest

import odkit
from odkit import _odkit

STUBS = os.path.join(os.path.dirname(odkit.__file__), "_odkit.pyi")


def test_the_stubs_name_every_member_and_no_other():
    with open(STUBS) as file:
        tree = ast.parse(file.read())
    declared, found = {}, {}
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            members = {getattr(one, "name", None) or one.target.id for one in node.body if not isinstance(one, ast.Expr)}
            declared[node.name] = set() if node.name in ("NodeError", "SdoAbort") else {name for name in members if not name.startswith("__")}
        elif isinstance(node, ast.FunctionDef):
            declared[node.name] = set()
    for name, value in vars(_odkit).items():
        if name.startswith("_"):
            continue
        is_class = isinstance(value, type) and not issubclass(value, Exception)
        found[name] = {one for one in vars(value) if not one.startswith("_")} if is_class else set()
    assert declared == found
    assert os.path.exists(os.path.join(os.path.dirname(STUBS), "py.typed"))


@pytest.mark.long
def test_mypy_finds_the_stubs_true(tmp_path):
    """Names, arguments and defaults are those that the compiled part has."""
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "venv"], check=True)
    python = next(path for path in (tmp_path / "venv").glob("*/python*") if path.is_file())
    packages = ["mypy", "python-can", "pytest"]
    subprocess.run([python, "-m", "pip", "install", "--quiet", *packages], check=True)
    site = os.path.dirname(os.path.dirname(odkit.__file__))
    surroundings = {**os.environ, "PYTHONPATH": site}
    for arguments in (["mypy.stubtest", "odkit._odkit"], ["mypy", "-p", "odkit"]):
        command = [python, "-m", *arguments]
        done = subprocess.run(command, cwd=tmp_path, env=surroundings, stdout=subprocess.PIPE, text=True)
        assert done.returncode == 0, done.stdout
