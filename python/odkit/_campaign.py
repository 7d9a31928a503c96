"""Many runs of one scenario, each with a seed of its own, in processes or on other computers."""

from __future__ import annotations

import base64
import functools
import json
import traceback
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from odkit import _odkit

Scenario = Callable[[_odkit.Bench, int], Any]
Check = Callable[[_odkit.Bench], Any]


@dataclass(frozen=True)
class Failure:
    """A seed with which a scenario fails."""

    #: The seed.
    seed: int
    #: The exception, such as ``AssertionError: no boot-up``.
    error: str
    #: Its traceback.
    trace: str = field(compare=False)
    #: The run as a script for ``odkit run``; ``None`` if a script has no line for one of its actions.
    script: str | None
    #: The script without the lines that the failure does not need; ``None`` if the script alone does not fail.
    shrunk: str | None
    #: The end of an address of the playground that shows it.
    link: str | None

    def __str__(self) -> str:
        return f"seed {self.seed}: {self.error}"


def campaign(
    scenario: Scenario,
    seeds: Sequence[int],
    start: _odkit.Snapshot | str | Sequence[str] | None = None,
    *,
    map: Callable[..., Iterable[Any]] = map,
    chunk: int = 200,
    check: Check | None = None,
    shrink: bool = True,
    progress: bool = False,
) -> Iterator[Failure]:
    """Runs ``scenario(bench, seed)`` for each seed, and yields the failures: seeds with which it raises an exception.

    ``start`` is a snapshot, or devices as for :class:`odkit.Bench`. ``map`` is any function that maps a function to a
    list: ``map``, that of a pool of ``multiprocessing`` or ``concurrent.futures``, or that of a client of Dask, whose
    results are futures. It gets ``chunk`` seeds at a time. ``scenario`` and ``check`` have to be functions of a module.

    ``check(bench)`` is run after the scenario, and after each script with fewer lines: a line is dropped if the
    exception has the same type without it. Without ``check`` a script fails by the ``expect`` that failed.
    ``progress`` shows a bar of tqdm.
    """
    if chunk < 1:
        raise ValueError(f"chunk is {chunk}; a chunk has 1 seed or more")
    if not hasattr(seeds, "__len__"):
        raise TypeError(f"seeds is {seeds!r}; write a range or a list, such as range(1000)")
    job = functools.partial(_chunk, scenario, start, check, shrink)
    chunks = [seeds[at : at + chunk] for at in range(0, len(seeds), chunk)]
    bar = None
    if progress:
        from tqdm import tqdm

        bar = tqdm(total=len(seeds), unit=" scenarios")
    for count, failures in _results(map(job, chunks)):
        if bar is not None:
            bar.update(count)
        yield from failures
    if bar is not None:
        bar.close()


def _results(results: Iterable[Any]) -> Iterator[tuple[int, list[Failure]]]:
    for result in results:
        yield result.result() if callable(getattr(result, "result", None)) else result


def _chunk(
    scenario: Scenario, start: Any, check: Check | None, shrink: bool, seeds: Sequence[int]
) -> tuple[int, list[Failure]]:
    if not isinstance(start, _odkit.Snapshot):
        with _odkit.Bench(start) as bench:
            start = bench.snapshot()
    failures = []
    for seed in seeds:
        with _odkit.Bench(start) as bench:
            try:
                scenario(bench, seed)
                if check is not None:
                    check(bench)
            except Exception as error:
                failures.append(_failure(bench, seed, error, check, shrink))
    return len(seeds), failures


def _failure(
    bench: _odkit.Bench, seed: int, error: Exception, check: Check | None, shrink: bool
) -> Failure:
    try:
        script = bench.script()
    except ValueError:
        script = None
    shrunk = None
    if script is not None and shrink:
        # A pattern that was not met is the last line of the script.
        shrunk = _odkit.shrink(script, lambda text: _fails(text, check) == type(error).__name__)
    link = link_of(script, bench.now) if script is not None else None
    text = f"{type(error).__name__}: {error}"
    return Failure(seed, text, "".join(traceback.format_exception(error)), script, shrunk, link)


def _fails(script: str, check: Check | None) -> str | None:
    """The type of the exception that a script or its check raises."""
    try:
        with _odkit.Bench(_odkit.play(script)) as bench:
            if check is not None:
                check(bench)
    except Exception as error:
        return type(error).__name__
    return None


def link_of(script: str, now: float) -> str:
    """The end of an address of the playground that repeats a script: ``#bench=…``."""
    bench = {
        "odkit": 1,
        "trace": True,
        "now": round(now * 1e6),
        "speed": 1,
        "running": False,
        "node": 0,
        "entries": [[0, {"op": "script", "text": script}]],
    }
    packed = zlib.compressobj(9, wbits=-15)
    data = packed.compress(json.dumps(bench).encode()) + packed.flush()
    return "#bench=" + base64.urlsafe_b64encode(data).decode().rstrip("=")
