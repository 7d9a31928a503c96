import pytest

import odkit


@pytest.fixture(autouse=True)
def no_wire_is_left():
    """A test leaves no wire of a channel open to the next one. Benches go with their fixtures."""
    yield
    assert [name for name in odkit.wires() if not name.startswith("bench-")] == []
