"""The campaign as tests: `pytest -n auto` of pytest-xdist spreads the parts over the cores."""

import os
import sys

import pytest

import odkit

sys.path.insert(0, os.path.dirname(os.path.dirname(__file__)))

from network import scenario, start  # noqa: E402

COUNT = int(os.environ.get("SCENARIOS", "20"))
PARTS = 4


@pytest.fixture(scope="module")
def snapshot():
    return start()


@pytest.mark.parametrize("part", range(PARTS))
def test_no_confirmed_value_is_lost(part, snapshot):
    failures = list(odkit.campaign(scenario, range(part, COUNT, PARTS), snapshot))
    assert not failures, "\n".join(f"{one}\n{one.shrunk or one.script}" for one in failures)
