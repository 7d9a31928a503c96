import os

import pytest

import odkit

LONG = bool(os.environ.get("ODKIT_LONG"))
CI = os.environ.get("CI") == "true"


def pytest_configure(config):
    config.addinivalue_line("markers", "long: only with ODKIT_LONG; it takes minutes, or the network")


def pytest_collection_modifyitems(config, items):
    """Leaves out the tests that run only with `--long`, so that none is reported as skipped."""
    left_out = [item for item in items if item.get_closest_marker("long") and not LONG]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if item not in left_out]


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport():
    report = (yield).get_result()
    if CI and report.skipped:
        report.outcome = "failed"
        report.longrepr = f"in CI a test that is skipped has failed: {report.longrepr[2]}"


@pytest.hookimpl(hookwrapper=True)
def pytest_make_collect_report():
    report = (yield).get_result()
    if CI and report.skipped:
        report.outcome = "failed"
        report.longrepr = f"in CI a file that is skipped has failed: {report.longrepr[2]}"


@pytest.fixture(autouse=True)
def no_wire_is_left():
    """A test leaves no wire of a channel open to the next one. Benches go with their fixtures."""
    yield
    assert [name for name in odkit.wires() if not name.startswith("bench-")] == []
