"""The waits of Python, as a bench sees them.

While a bench in virtual time is open, ``time.sleep``, the conditions and threads of ``threading``, the queues, and the
event loops of ``asyncio`` report to it that a thread waits, for how long, and that it was woken. Everything
else of ``threading``, ``queue`` and ``concurrent.futures`` waits in a condition. Threads that do not
take part on a bus wait as ever.
"""

from __future__ import annotations

import asyncio
import atexit
import collections
import contextlib
import faulthandler
import queue
import re
import selectors
import sys
import tempfile
import threading
import time
import types
import warnings
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import can.listener

from odkit import _odkit

_sleep = time.sleep
_wait = threading.Condition.wait
_notify = threading.Condition.notify
_start = threading.Thread.start
_join = threading.Thread.join
_call_soon_threadsafe = asyncio.BaseEventLoop.call_soon_threadsafe
_loop_time = asyncio.BaseEventLoop.time
_processor_of = getattr(time, "pthread_getcpuclockid", None)

if TYPE_CHECKING:
    _Thread = weakref.ref[threading.Thread]


def this() -> tuple[int, _Thread, int | None]:
    """The calling thread: its number, a reference to it, and the clock of its processor time."""
    ident = threading.get_ident()
    processor = _processor_of(ident) if _processor_of else None
    return ident, weakref.ref(threading.current_thread()), processor


def look(threads: list[tuple[_Thread, int | None, _Thread | None]]) -> list[tuple[bool, float | None, bool]]:
    """For each thread: whether it lives, its processor time, and whether the thread that it waits for lives."""
    return [_look(*one) for one in threads]


def _look(reference: _Thread, processor: int | None, target: _Thread | None) -> tuple[bool, float | None, bool]:
    thread = reference()
    lives = _lives(thread)
    seconds = None
    if lives and processor is not None:
        try:
            seconds = time.clock_gettime(processor)
        except OSError:
            lives = False
    return lives, seconds, target is not None and _lives(target())


def _lives(thread: threading.Thread | None) -> bool:
    # While another thread joins it, `is_alive` may say that a thread lives that has ended.
    return thread is not None and not hasattr(thread, "odkit_ended") and thread.is_alive()


def report(reference: _Thread, strict: bool) -> None:
    """Warns that a thread waits for something that no call reports; with ``strict`` that is an error."""
    thread = reference()
    if thread is None:
        return
    text = (
        f"{thread.name} waits for something that odkit does not see, at {_place(thread)}: the time of the bus "
        "follows the clock until it goes on"
    )
    if strict:
        raise RuntimeError(f'{text}, and the bus has time="strict"')
    warnings.warn(text, RuntimeWarning, stacklevel=2)


def report_long(reference: _Thread) -> None:
    """Warns that a thread has computed for long while others wait for it."""
    thread = reference()
    if thread is not None:
        warnings.warn(
            f"{thread.name} has computed for 10 s without a wait that odkit sees, now at {_place(thread)}: the time of "
            "the bus stands still until it waits; a loop that waits for another thread needs a call such as "
            "`time.sleep(0.001)`",
            RuntimeWarning,
            stacklevel=2,
        )


def _place(thread: threading.Thread) -> str:
    with tempfile.TemporaryFile("w+") as file:
        faulthandler.dump_traceback(file, all_threads=True)
        file.seek(0)
        text = file.read()
    found = re.search(rf"hread 0x0*{thread.ident:x} .*\n\s*File (.*)", text)
    return found[1] if found else "an unknown line"


class _Sleeper:
    """A thread that waits for a condition."""

    __slots__ = ("ident", "woken")

    def __init__(self) -> None:
        self.ident, self.woken = threading.get_ident(), False


def wait(self: threading.Condition, timeout: float | None = None) -> bool:
    if (timeout is not None and timeout <= 0) or not _odkit.takes_part():
        return _wait(self, timeout)
    own = _Sleeper()
    sleepers = vars(self).setdefault("odkit_sleepers", [])
    sleepers.append(own)

    try:
        for pause in _odkit.Waiting(timeout):
            _wait(self, pause)
            if own.woken:
                return True
        return own.woken
    finally:
        sleepers.remove(own)


def notify(self: threading.Condition, n: int = 1) -> None:
    sleepers = vars(self).get("odkit_sleepers")
    if not sleepers:
        _notify(self, n)
        return
    # Raises if the lock is not held.
    _notify(self, n + len(sleepers))
    for one in [one for one in sleepers if not one.woken][:n]:
        one.woken = True
        _odkit.wake(one.ident)


def sleep(seconds: float) -> None:
    if not seconds > 0 or not _odkit.takes_part():
        _sleep(seconds)
        return
    for pause in _odkit.Waiting(seconds):
        _sleep(pause)


def start(self: threading.Thread) -> None:
    if not _odkit.takes_part():
        _start(self)
        return
    child, run = _odkit.Child(weakref.ref(self)), self.run

    def begin() -> None:
        del vars(self)["run"]
        child.begin()
        try:
            run()
        finally:
            vars(self)["odkit_ended"] = True

    vars(self)["run"] = begin
    try:
        _start(self)
    except BaseException:
        child.end()
        raise


def join(self: threading.Thread, timeout: float | None = None) -> None:
    # Its own thread and one that has not started raise.
    if not (self.is_alive() and _odkit.takes_part()) or self is threading.current_thread():
        _join(self, timeout)
        return

    most = None if timeout is None else max(timeout, 0)
    for pause in _odkit.Waiting(most, False, weakref.ref(self)):
        _join(self, pause)
        if not self.is_alive():
            _join(self)
            return


def _selecting(select: Callable[..., Any]) -> Callable[..., Any]:
    def wrapped(self: Any, timeout: float | None = None) -> Any:
        if (timeout is not None and timeout <= 0) or not _odkit.takes_part():
            return select(self, timeout)
        for pause in _odkit.Waiting(timeout):
            ready = select(self, pause)
            if ready:
                return ready
        return select(self, 0)

    return wrapped


def loop_time(self: asyncio.BaseEventLoop) -> float:
    own = vars(self)
    clock = own.get("odkit_clock")
    if clock is None:
        clock = own["odkit_clock"] = Clock(lambda: round(_loop_time(self) * 1e9))
    own["odkit_ident"] = threading.get_ident()
    return clock() / 1e9


def call_soon_threadsafe(self: asyncio.BaseEventLoop, *args: Any, **keywords: Any) -> Any:
    handle = _call_soon_threadsafe(self, *args, **keywords)
    ident = vars(self).get("odkit_ident")
    if ident is not None:
        _odkit.wake(ident)
    return handle


class SimpleQueue:
    """``queue.SimpleQueue`` that waits in a condition. A garbage collection during ``get`` may ``put``."""

    def __init__(self) -> None:
        self._items: collections.deque[Any] = collections.deque()
        self._filled = threading.Condition()

    def put(self, item: Any, block: bool = True, timeout: float | None = None) -> None:
        with self._filled:
            self._items.append(item)
            self._filled.notify()

    def get(self, block: bool = True, timeout: float | None = None) -> Any:
        if timeout is not None and timeout < 0:
            raise ValueError("'timeout' must be a non-negative number")
        with self._filled:
            if not self._items and block:
                self._filled.wait_for(lambda: self._items, timeout)
            if not self._items:
                raise queue.Empty
            return self._items.popleft()

    def put_nowait(self, item: Any) -> None:
        self.put(item)

    def get_nowait(self) -> Any:
        return self.get(False)

    def empty(self) -> bool:
        return not self._items

    def qsize(self) -> int:
        return len(self._items)


class Clock:
    """A clock in nanoseconds that follows the bench of the calling thread while that takes part on one."""

    def __init__(self, real: Callable[[], int]) -> None:
        self._real, self._last = real, real()
        self._ahead: dict[int | None, int] = {None: 0}
        self.moment: tuple[int | None, int] | None = None

    def __call__(self) -> int:
        self.moment = bench, micros = _odkit.moment() or (None, 0)
        now = self._real() if bench is None else micros * 1000
        ahead = self._ahead.setdefault(bench, self._last - now)
        if bench is None:
            # Without a bench the clock continues from the time of the last one, which may be hours ahead.
            ahead = self._ahead[None] = max(ahead, self._last - now)
        self._last = now + ahead
        return self._last


def install() -> None:
    """Lets the waits of Python report to benches. Nothing else about them changes."""
    if threading.Condition.wait is wait:
        return
    replaced: list[tuple[Any, str, Any]] = [
        (threading.Condition, "wait", wait),
        (threading.Condition, "notify", notify),
        (threading.Thread, "start", start),
        (threading.Thread, "join", join),
        (time, "sleep", sleep),
        (asyncio.BaseEventLoop, "time", loop_time),
        (asyncio.BaseEventLoop, "call_soon_threadsafe", call_soon_threadsafe),
        (queue, "SimpleQueue", SimpleQueue),
        (can.listener, "SimpleQueue", SimpleQueue),
    ]
    for name in ("SelectSelector", "PollSelector", "EpollSelector", "DevpollSelector", "KqueueSelector"):
        selector = getattr(selectors, name, None)
        if selector is not None:
            replaced.append((selector, "select", _selecting(selector.select)))
    for owner, name, own in replaced:
        setattr(owner, name, own)
    atexit.register(_odkit.end_program)


class _Shown(Clock):
    """A clock of ``time`` during ``patch_time``."""

    #: Readings in a row that let 1 ms pass, so that a loop which only reads the clock ends.
    READINGS = 1000

    def __init__(self, real: Callable[[], int]) -> None:
        super().__init__(real)
        self._readings = 0

    def __call__(self) -> int:
        before = self.moment
        now = super().__call__()
        self._readings = self._readings + 1 if self.moment == before else 0
        if self._readings >= self.READINGS and _odkit.takes_part():
            self._readings = 0
            sleep(0.001)
            now = super().__call__()
        # Each reading is later than the one before, so that a loop with a time-out ends.
        return now + self._readings


class patch_time(contextlib.ContextDecorator):
    """The waits of Python take no time on the clock, and the clocks of ``time`` show the time of the bench.

    For the length of a ``with`` block, or of a function that it decorates. ``time.time``, ``monotonic``,
    ``perf_counter`` and their ``_ns`` are replaced in every module that has imported them. They
    follow the bench on which the calling thread takes part, or else the oldest one, and
    stand still while the program computes; each 1000th reading in a row lets 1 ms pass.
    """

    def __enter__(self) -> patch_time:
        install()
        shown: dict[Any, Any] = {}
        for name in ("time", "monotonic", "perf_counter"):
            nanos = _Shown(getattr(time, f"{name}_ns"))
            shown[getattr(time, f"{name}_ns")] = nanos
            shown[getattr(time, name)] = lambda nanos=nanos: nanos() / 1e9
        shown[_sleep] = sleep
        self._replaced: list[tuple[Any, str, Any]] = []
        for module in list(sys.modules.values()):
            if getattr(module, "__name__", "").split(".")[0] in ("_pytest", "odkit"):
                continue
            for name, value in list(getattr(module, "__dict__", {}).items()):
                if type(value) is types.BuiltinFunctionType and value in shown:
                    self._replaced.append((module, name, value))
                    setattr(module, name, shown[value])
        _odkit.patch(True)
        return self

    #: The computer's own clock, in seconds.
    real = staticmethod(time.perf_counter)

    def __exit__(self, *_error: object) -> None:
        _odkit.patch(False)
        for module, name, value in reversed(self._replaced):
            setattr(module, name, value)
