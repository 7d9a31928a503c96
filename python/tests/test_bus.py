"""The interface of python-can, in one thread."""

import time

import can
import pytest

import odkit


def open_bus(channel="gxmm@1", **kwargs):
    return can.Bus(interface="odkit", channel=channel, **kwargs)


def frame(text):
    can_id, data = text.split("#")
    return can.Message(
        arbitration_id=int(can_id, 16), is_extended_id=len(can_id) == 8, data=bytes.fromhex(data)
    )


def text(message):
    return f"{message.arbitration_id:03X}#{message.data.hex().upper()}"


def received(bus, timeout):
    return [(round(one.timestamp, 6), text(one)) for one in iter(lambda: bus.recv(timeout), None)]


def test_devices_boot_and_answer():
    with open_bus("gxmm@1,eam_mt@2") as bus:
        assert received(bus, 0) == [(0.0, "701#00"), (0.0, "702#00")]
        bus.send(frame("602#4000100000000000"))
        answer = bus.recv(1)
        assert text(answer) == "582#4300100096010200"
        assert answer.channel == "gxmm@1,eam_mt@2" and answer.is_rx
        assert not (answer.is_extended_id or answer.is_remote_frame or answer.is_error_frame)


def test_a_drive_and_an_io_module_by_name():
    with open_bus("drive@3,gxmm@4,io@5") as bus:
        assert [text(one) for _, one in zip(range(3), iter(lambda: bus.recv(0), None))] == ["703#00", "704#00", "705#00"]
        assert [device.name for device in bus.bench.devices] == ["drive", "gxmm", "io"]
        # Controlword: shutdown, switch on, enable operation. The statusword follows (CiA 402).
        for command, state in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)):
            bus.send(frame(f"603#2B406000{command:02X}000000"))
            assert text(bus.recv(1)) == "583#6040600000000000"
            bus.send(frame("603#4041600000000000"))
            assert bus.recv(1).data[4] & 0x6F == state
        for node, profile in ((3, 402), (4, 406), (5, 401)):
            bus.send(frame(f"{0x600 + node:X}#4000100000000000"))
            assert int.from_bytes(bus.recv(1).data[4:], "little") & 0xFFFF == profile


def test_a_time_out_is_over_at_once():
    began = time.perf_counter()
    with open_bus() as bus:
        received(bus, 0)
        assert bus.recv(3600) is None
        assert bus.bench.now == 3600
        assert bus.recv(0) is None and bus.recv(-1) is None
        assert bus.bench.now == 3600
    assert time.perf_counter() - began < 60


def test_an_hour_of_heartbeats_is_the_same_each_time():
    def hour():
        with open_bus() as bus:
            received(bus, 0)
            bus.send(frame("601#2B171000E8030000"))
            frames = []
            while not frames or frames[-1][0] < 3600:
                one = bus.recv(2)
                frames.append((one.timestamp, text(one)))
        return frames

    first = hour()
    assert len(first) == 3601 and first[-1] == (3600.0, "701#7F")
    assert all(hour() == first for _ in range(3))


def test_buses_of_one_channel_share_a_wire():
    with open_bus("gxmm@1") as one, open_bus("gxmm@1", receive_own_messages=True) as other:
        received(one, 0)
        one.send(frame("123#01"))
        assert text(other.recv(0)) == "123#01"
        assert one.recv(0) is None
        other.send(frame("00000124#02"))
        back = other.recv(0)
        assert text(back) == "124#02" and back.is_extended_id and not back.is_rx
        assert text(one.recv(0)) == "124#02"
        with open_bus("gxmm@5") as elsewhere:
            received(elsewhere, 0)
            one.send(frame("123#01"))
            assert elsewhere.recv(0) is None


def test_a_wire_has_a_name():
    with open_bus("line=gxmm@1") as one, open_bus("line") as other:
        assert other.bench.name == "line" and len(other.bench) == 1
        one.send(frame("123#01"))
        assert text(other.recv(0)) == "123#01"
    with pytest.raises(can.CanInitializationError, match="no built-in device or file is named `line`"):
        open_bus("line")


def test_filters():
    with open_bus("", can_filters=[{"can_id": 0x120, "can_mask": 0x7F0, "extended": False}]) as bus:
        with open_bus("") as other:
            for one in ("11F#01", "120#02", "12F#03", "00000120#04"):
                other.send(frame(one))
            assert [text(one) for one in iter(lambda: bus.recv(0), None)] == ["120#02", "12F#03"]
            bus.set_filters(None)
            other.send(frame("11F#01"))
            assert text(bus.recv(0)) == "11F#01"


def test_periodic_messages_are_in_the_time_of_the_bus():
    with open_bus("") as bus, open_bus("") as other:
        task = bus.send_periodic(frame("100#01"), 0.01)
        got = [other.recv(1) for _ in range(5)]
        assert [round(one.timestamp, 6) for one in got] == [0, 0.01, 0.02, 0.03, 0.04]
        task.modify_data(frame("100#02"))
        assert text(other.recv(1)) == "100#02"
        task.stop()
        assert other.recv(1) is None
        task.start()
        assert text(other.recv(0.001)) == "100#02"
        task.stop()
        limited = bus.send_periodic([frame("101#01"), frame("101#02")], 0.1, duration=0.35)
        assert [one for _, one in received(other, 1)] == ["101#01", "101#02", "101#01", "101#02"]
        assert limited.duration == 0.35


def test_a_callback_modifies_periodic_messages():
    def count(message):
        message.data[0] += 1

    with open_bus("") as bus, open_bus("") as other:
        bus.send_periodic(frame("100#00"), 0.01, modifier_callback=count)
        assert [other.recv(1).data[0] for _ in range(4)] == [1, 2, 3, 4]


def test_an_exception_in_a_callback_comes_out_where_time_moves():
    def fail(message):
        raise RuntimeError("no data")

    with open_bus("") as bus, open_bus("") as other:
        bus.send_periodic(frame("100#00"), 0.01, modifier_callback=fail)
        with pytest.raises(RuntimeError, match="no data"):
            other.recv(1)
        bus.stop_all_periodic_tasks()
        assert other.recv(1) is None


def test_error_frames_and_the_state_of_the_controller():
    with open_bus("gxmm@1") as bus:
        received(bus, 0)
        bus.bench.real_line = True
        bus.bench["gxmm"].plugged = False
        bus.send(frame("123#01"))
        # Each one adds 8 to a counter, which is passive from 128 on.
        for _ in range(16):
            assert bus.state is can.BusState.ACTIVE
            assert bus.recv(1).is_error_frame
        assert bus.state is can.BusState.PASSIVE
        with pytest.raises(NotImplementedError):
            bus.state = can.BusState.ACTIVE


def test_frames_take_their_time_on_a_real_line():
    with open_bus("gxmm@1") as bus:
        received(bus, 0)
        bus.bench.real_line = True
        bus.send(frame("601#4000100000000000"))
        answer = bus.recv(1)
        assert text(answer) == "581#4300100096010200"
        assert 0.0002 < answer.timestamp < 0.01


def test_a_bit_rate_of_another_device():
    with open_bus("gxmm@1", bitrate=20_000) as bus:
        received(bus, 0)
        bus.send(frame("601#4000100000000000"))
        assert bus.recv(1) is None
        bus.bench.bit_rate = bus.bench["gxmm"].bit_rate
        bus.send(frame("601#4000100000000000"))
        assert bus.recv(1) is not None


def test_real_time():
    with open_bus("gxmm@1", time="real") as bus:
        began, clock = time.time(), time.perf_counter()
        first = bus.recv(1)
        assert abs(first.timestamp - began) < 60
        assert bus.recv(0.05) is None
        assert time.perf_counter() - clock >= 0.05
        bus.send(frame("601#2B17100014000000"))
        assert text(bus.recv(5)) == "581#6017100000000000"
        ticks = [bus.recv(5).timestamp for _ in range(3)]
        assert 0.019 < ticks[1] - ticks[0] < 0.021 and 0.019 < ticks[2] - ticks[1] < 0.021
        with pytest.raises(can.CanInitializationError, match="is open in real time"):
            open_bus("gxmm@1", time="virtual")


def test_what_cannot_be_says_so():
    with pytest.raises(can.CanInitializationError, match="no built-in device or file is named `gxm`"):
        open_bus("gxm@1")
    with pytest.raises(can.CanInitializationError, match="`0` is not a node ID"):
        open_bus("gxmm@0")
    with pytest.raises(can.CanInitializationError, match="does not support CAN FD"):
        open_bus("gxmm@1", fd=True)
    with pytest.raises(can.CanInitializationError, match="write `virtual`, `strict` or `real`"):
        open_bus("gxmm@1", time="fast")
    with open_bus("") as bus:
        with pytest.raises(can.CanOperationError, match="CAN FD"):
            bus.send(can.Message(is_fd=True))
        with pytest.raises(TypeError, match="send a can.Message, not str"):
            bus.send("123#")
        with pytest.raises(can.CanOperationError, match="error frame"):
            bus.send(can.Message(is_error_frame=True))


def test_closed_twice():
    bus = open_bus()
    bus.shutdown()
    bus.shutdown()
    for use in (lambda: bus.recv(0), lambda: bus.send(frame("123#")), lambda: bus.bench):
        with pytest.raises(can.CanOperationError, match="the bus is closed"):
            use()


def test_detect_available_configs():
    with open_bus("line=gxmm@1"):
        found = can.detect_available_configs(interfaces=["odkit"])
    # A test that failed may still hold its bench.
    found = [one for one in found if not one["channel"].startswith("bench-")]
    channels = [one["channel"] for one in found]
    assert channels[0] == "line" and {"gxmm@1", "eam_mt@1", "en580c@1"} <= set(channels)
    for one in found[1:]:
        can.Bus(**one).shutdown()
    assert all(name.startswith("bench-") for name in odkit.wires())
