"""The interface ``odkit`` of python-can."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import can
from can import BusABC, CanInitializationError, CanOperationError, Message
from can.broadcastmanager import (
    LimitedDurationCyclicSendTaskABC,
    ModifiableCyclicTaskABC,
    RestartableCyclicTaskABC,
)

from odkit import _odkit

if TYPE_CHECKING:
    from can.typechecking import AutoDetectedConfig, CanFilters

_T = TypeVar("_T")
_Frame = tuple[int, bool, bool, int, bytes]
_LOG = logging.getLogger("can.odkit")
_STATES = (can.BusState.ACTIVE, can.BusState.PASSIVE, can.BusState.ERROR)


class OdkitBus(BusABC):
    """A station on a bus with CANopen devices in it.

    :param channel: The devices, such as ``gxmm@1,eam_mt@2`` or ``my.eds+coarse.overlay@5``, or the
        name of a wire that is open. ``line=gxmm@1`` gives a new wire a name. All buses of one channel
        or name share the wire; the devices live as long as one of them is open.
    :param can_filters: The filters of python-can.
    :param receive_own_messages: Whether the bus receives what it sends.
    :param time: ``virtual``, the default of a new wire: time moves while all that take part wait.
        ``strict``: so, too, but a wait that lets time follow the clock raises. ``real``: time follows the clock.
    :param pace: Seconds on a new wire for each second of the clock while time follows the clock; 1 by default.
    :param bitrate: In bit/s. Devices with another bit rate do not hear the bus. Without it they do.
    :raises can.CanInitializationError: A device does not exist, a file cannot be read.
    """

    def __init__(
        self,
        channel: Any = "",
        can_filters: CanFilters | None = None,
        receive_own_messages: bool = False,
        time: _odkit._Time | None = None,
        bitrate: int | None = None,
        bench: _odkit.Bench | None = None,
        fd: bool = False,
        pace: float | None = None,
        **kwargs: Any,
    ) -> None:
        if fd:
            raise CanInitializationError("odkit does not support CAN FD; leave out `fd`")
        channel = "" if channel is None else str(channel)
        try:
            self._port = _odkit.Port(channel, time, receive_own_messages, bitrate, bench, pace)
        except (ValueError, OSError) as error:
            raise CanInitializationError(str(error)) from None
        self.channel = channel
        self.channel_info = f"odkit {channel}"
        super().__init__(channel=channel, can_filters=can_filters, **kwargs)

    @property
    def bench(self) -> _odkit.Bench:
        """The :class:`odkit.Bench` of the wire."""
        return self._call(self._port.bench)

    @property
    def state(self) -> can.BusState:
        """The state of the CAN controller. Only a real line of the bench changes it."""
        return _STATES[self._call(self._port.condition)]

    @state.setter
    def state(self, new_state: can.BusState) -> None:
        raise NotImplementedError("the line decides which state the controller has")

    def recv(self, timeout: float | None = None) -> Message | None:
        """The next message, or ``None`` when ``timeout`` seconds of the bus's time are over.

        In virtual time they are over as soon as the other threads that take part on the wire wait, too.

        :raises can.CanOperationError: The bus is closed.
        """
        try:
            heard = self._port.recv(timeout)
        except OSError as error:
            raise CanOperationError(str(error)) from None
        if heard is None:
            return None
        message = Message(*heard)
        if can.bus.LOG.isEnabledFor(self.RECV_LOGGING_LEVEL):
            can.bus.LOG.log(self.RECV_LOGGING_LEVEL, "Received: %s", message)
        return message

    def _recv_internal(self, timeout: float | None) -> tuple[Message | None, bool]:
        return OdkitBus.recv(self, timeout), True

    def send(self, msg: Message, timeout: float | None = None) -> None:
        """Sends a message. It does not wait: ``timeout`` is ignored.

        :raises can.CanOperationError: The bus is closed, the controller is bus-off, or the message is
            not a frame of classical CAN.
        :raises TypeError: It is not a ``can.Message``.
        """
        try:
            self._port.send(_parts(msg))
        except (OSError, ValueError) as error:
            raise CanOperationError(str(error)) from None

    def __repr__(self) -> str:
        return f"<odkit.bus.OdkitBus {self.channel}>"

    def flush_tx_buffer(self) -> None:
        """Does nothing: every sent message is already on the line."""

    def shutdown(self) -> None:
        """Leaves the wire. Its devices go with the last bus or bench of the wire."""
        super().shutdown()
        self._port.close()

    def _apply_filters(self, filters: CanFilters | None) -> None:
        passing = None
        if filters:
            passing = [(f["can_id"], f["can_mask"], f.get("extended")) for f in filters]
        self._call(self._port.set_filters, passing)

    def _send_periodic_internal(
        self,
        msgs: Sequence[Message] | Message,
        period: float,
        duration: float | None = None,
        autostart: bool = True,
        modifier_callback: Callable[[Message], None] | None = None,
    ) -> CyclicTask:
        return CyclicTask(self._port, msgs, period, duration, autostart, modifier_callback)

    @staticmethod
    def _call(function: Callable[..., _T], *args: Any) -> _T:
        try:
            return function(*args)
        except OSError as error:
            raise CanOperationError(str(error)) from None

    @staticmethod
    def _detect_available_configs() -> Sequence[AutoDetectedConfig]:
        channels = _odkit.wires()
        channels += [f"{name}@1" for name, _ in _odkit.devices()]
        return [{"interface": "odkit", "channel": channel} for channel in channels]


class CyclicTask(
    LimitedDurationCyclicSendTaskABC, ModifiableCyclicTaskABC, RestartableCyclicTaskABC
):
    """Messages that are sent periodically, in the time of the bus."""

    def __init__(
        self,
        port: _odkit.Port,
        messages: Sequence[Message] | Message,
        period: float,
        duration: float | None,
        autostart: bool,
        modifier_callback: Callable[[Message], None] | None,
    ) -> None:
        super().__init__(messages, period, duration)
        self._port = port
        self._modify = modifier_callback
        maker = self._make if modifier_callback else None
        frames = [_parts(message) for message in self.messages]
        try:
            self._task = port.task(frames, period, duration, maker)
        except (OSError, ValueError) as error:
            raise CanOperationError(str(error)) from None
        if autostart:
            self.start()

    def _make(self, place: int) -> _Frame:
        message = self.messages[place]
        if self._modify:
            self._modify(message)
        return _parts(message)

    def start(self) -> None:
        """Starts, or starts again, with the first message."""
        OdkitBus._call(self._port.start_task, self._task)

    def stop(self) -> None:
        """Stops sending."""
        self._port.stop_task(self._task)

    def modify_data(self, messages: Sequence[Message] | Message) -> None:
        """From now on sends other data with the same CAN-IDs.

        :raises ValueError: The CAN-IDs differ.
        """
        messages = self._check_and_convert_messages(messages)
        self._check_modified_messages(messages)
        self.messages = messages
        OdkitBus._call(self._port.change_task, self._task, [_parts(one) for one in messages])


def _parts(msg: Message) -> _Frame:
    if not isinstance(msg, Message):
        raise TypeError(f"send a can.Message, not {type(msg).__name__}")
    if msg.is_fd:
        raise CanOperationError("odkit does not support CAN FD; send a message without `is_fd`")
    if msg.is_error_frame:
        raise CanOperationError("a program cannot send an error frame; `bench.terminators` makes some")
    return (
        msg.arbitration_id,
        msg.is_extended_id,
        msg.is_remote_frame,
        msg.dlc,
        bytes(msg.data),
    )
