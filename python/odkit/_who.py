"""Which other threads run and which wait. Time moves while all threads on a wire wait.

A thread waits when ``threading``, ``queue``, ``concurrent.futures`` or ``asyncio`` has put it to sleep.
A thread that was notified but has not run yet no longer waits: its lock is already open.
"""

import sys
import threading
from concurrent.futures import thread as _pool

_GONE, _RUNS, _EVER = -2.0, -1.0, float("inf")
_WAIT = threading.Condition.wait.__code__
_JOIN = threading.Thread.join.__code__
_START = threading.Thread.start.__code__
_LOCK = getattr(getattr(threading.Thread, "_wait_for_tstate_lock", None), "__code__", None)
_WORK = getattr(getattr(_pool, "_worker", None), "__code__", None)
_WAITERS = ("threading", "queue")


def this():
    """The calling thread: its number, its number in the operating system, and its daemon flag."""
    return (
        threading.get_ident(),
        threading.get_native_id(),
        threading.current_thread().daemon,
    )


def threads():
    """The same of all threads."""
    return [(one.ident, one.native_id, one.daemon) for one in threading.enumerate() if one.native_id]


def waits(threads):
    """Three values for each thread. The first is -2 if it ended, -1 if it runs, otherwise the seconds that
    it waits at most. The second tells whether the wait can end without a sign in Python. The third is
    an object that identifies the wait."""
    found = _look(threads)
    if len(threads) > 1 and all(one[0] != _RUNS for one in found):
        # A later thread may have woken an earlier one after that one was looked at: look again.
        pairs = zip(found, _look(threads))
        return [one if one[2] is other[2] else (_RUNS, False, None) for one, other in pairs]
    return found


def _look(threads):
    frames = sys._current_frames()
    found = []
    for ident in threads:
        frame = frames.get(ident)
        if frame is None:
            found.append((_GONE, False, None))
            continue
        wait = _wait(frame, frames)
        if wait is None:
            found.append((_RUNS, False, None))
        else:
            found.append((_seconds(wait[1]), wait[2], wait[0]))
    return found


def _seconds(timeout):
    if timeout is None or timeout < 0:
        return _EVER
    # Round the rest of a time-out up: 0.29999 s is 0.3 s.
    return -(-round(timeout * 1e6) // 1000) / 1000


def _wait(frame, frames):
    """The object that identifies the wait of a thread, its time-out, and whether its end is hidden.
    ``None`` if it runs."""
    code = frame.f_code
    if code is _WAIT:
        local = frame.f_locals
        waiter = local.get("waiter")
        # The thread that notifies opens the lock and removes it from the list; this thread closes it again.
        if waiter is None or not waiter.locked() or waiter not in local["self"]._waiters:
            return None
        return _timed(frame, waiter, local.get("timeout"))
    if code is _LOCK:
        # This lock is closed again, too, but by then the awaited thread has no frame.
        if frame.f_locals["self"].ident not in frames:
            return None
        return _timed(frame, frame, frame.f_locals.get("timeout"))
    if code is _JOIN:
        local = frame.f_locals
        return (frame, local.get("timeout"), False) if local["self"].is_alive() else None
    if code is _WORK:
        local = frame.f_locals
        if local.get("work_item") is not None or not local["work_queue"].empty():
            return None
        return frame, None, True
    if code.co_name == "get_message" and frame.f_globals.get("__name__") == "can.listener":
        local = frame.f_locals
        return (frame, local["timeout"], True) if local["self"].buffer.empty() else None
    if code.co_name == "select" and frame.f_globals.get("__name__") == "selectors":
        return _loop(frame)
    return None


def _timed(frame, token, timeout):
    """A wait with the time-out of its outermost call; the innermost wait has only the rest of it.
    A thread that starts another thread counts as running."""
    outer = frame.f_back
    while outer is not None and outer.f_globals.get("__name__") in _WAITERS:
        if outer.f_code is _START:
            return None
        timeout = outer.f_locals.get("timeout", timeout)
        outer = outer.f_back
    return token, timeout, False


def _loop(frame):
    """An event loop of asyncio that has nothing to do."""
    loop = frame.f_back and frame.f_back.f_locals.get("self")
    ready = getattr(loop, "_ready", None)
    if ready is None or ready:
        return None
    return frame, frame.f_locals.get("timeout"), False
