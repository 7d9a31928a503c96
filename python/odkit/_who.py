"""What other threads do: time moves while all that take part on a wire wait.

A thread waits where ``threading``, ``queue``, ``concurrent.futures`` or ``asyncio`` put it to sleep.
One that has been notified and has not run yet does not wait any more: the lock that it sleeps on is
open by then.
"""

import sys
import threading
from concurrent.futures import thread as _pool

_GONE, _RUNS, _SAME, _EVER = -2.0, -1.0, float("nan"), float("inf")
_WAIT = threading.Condition.wait.__code__
_JOIN = threading.Thread.join.__code__
_LOCK = getattr(getattr(threading.Thread, "_wait_for_tstate_lock", None), "__code__", None)
_WORK = getattr(getattr(_pool, "_worker", None), "__code__", None)
_WAITERS = ("threading", "queue")


def this():
    """Number, number of the system, and daemon flag of the thread that calls."""
    return (
        threading.get_ident(),
        threading.get_native_id(),
        threading.current_thread().daemon,
    )


def waits(threads, memory):
    """For each thread: -2 it ended, -1 it runs, a number: it waits for at most so many seconds,
    not a number: it waits as it did the last time."""
    frames = sys._current_frames()
    found = []
    for ident in threads:
        frame = frames.get(ident)
        if frame is None:
            memory.pop(ident, None)
            found.append(_GONE)
            continue
        wait = _wait(frame)
        if wait is None:
            memory.pop(ident, None)
            found.append(_RUNS)
        elif memory.get(ident) is wait[0]:
            found.append(_SAME)
        else:
            # The token lives on here, so that no later wait has the same.
            memory[ident] = wait[0]
            found.append(_seconds(wait[1]))
    return found


def _seconds(timeout):
    if timeout is None or timeout < 0:
        return _EVER
    # A rest of a time-out, such as 0.29999 s, is what it is a rest of.
    return -(-round(timeout * 1e6) // 1000) / 1000


def _wait(frame):
    """The token of the wait that a thread is in, and its time-out; ``None``: it runs."""
    code = frame.f_code
    if code is _WAIT:
        local = frame.f_locals
        waiter = local.get("waiter")
        if waiter is None or not waiter.locked():
            return None
        return waiter, _timeout(frame, local.get("timeout"))
    if code is _LOCK:
        lock = frame.f_locals.get("lock")
        if lock is None or not lock.locked():
            return None
        return frame, _timeout(frame, frame.f_locals.get("timeout"))
    if code is _JOIN:
        local = frame.f_locals
        return (frame, local.get("timeout")) if local["self"].is_alive() else None
    if code is _WORK:
        return (frame, None) if frame.f_locals.get("work_item") is None else None
    if code.co_name == "select" and frame.f_globals.get("__name__") == "selectors":
        return _loop(frame)
    return None


def _timeout(frame, timeout):
    """The time-out of the call that waits: that of the innermost wait is what is left of it."""
    outer = frame.f_back
    while outer is not None and outer.f_globals.get("__name__") in _WAITERS:
        timeout = outer.f_locals.get("timeout", timeout)
        outer = outer.f_back
    return timeout


def _loop(frame):
    """An event loop of asyncio that has nothing to do."""
    loop = frame.f_back and frame.f_back.f_locals.get("self")
    ready = getattr(loop, "_ready", None)
    if ready is None or ready:
        return None
    return frame, frame.f_locals.get("timeout")
