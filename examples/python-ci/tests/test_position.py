"""The axis against a virtual encoder. The same files would run against a real one."""

import os
import sys

import canopen
import pytest

HERE = os.path.dirname(__file__)
sys.path.insert(0, os.path.dirname(HERE))

from position import Axis  # noqa: E402

# Write the path of your EDS file; this is the file of an encoder of odkit.
EDS = os.path.join(HERE, "../../../devices/eds/GXMM.eds")


@pytest.fixture
def axis(odkit_bench):
    network = canopen.Network()
    network.connect(interface="odkit", channel=odkit_bench.name)
    yield Axis(network, 1, EDS)
    network.disconnect()


def test_the_position_follows_the_shaft(axis, odkit_bench):
    shaft = odkit_bench["gxmm"]
    shaft.turns = 2.5
    axis.wait_for_position()
    assert axis.wait_for_position() == pytest.approx(2.5, abs=0.001)
    shaft.rpm = 60
    odkit_bench.run(10)
    assert axis.revolutions == pytest.approx(12.5, abs=0.02)


def test_a_silent_encoder_is_noticed(axis, odkit_bench):
    axis.wait_for_position()
    odkit_bench["gxmm"].power = False
    with pytest.raises(TimeoutError):
        axis.wait_for_position(timeout=0.1)


def test_a_fault_reaches_the_program(axis, odkit_bench):
    odkit_bench["gxmm"].fault("position-error")
    odkit_bench.run(0.1)
    assert axis.errors
