"""A client for programs with asyncio."""

from __future__ import annotations

import asyncio
import functools
import threading
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, TypeVar

from odkit._odkit import Client, Node

if TYPE_CHECKING:
    from types import TracebackType

_T = TypeVar("_T")


class AsyncClient:
    """:class:`odkit.Client` with coroutines: ``await client.upload(5, 0x1018, 1)``.

    The methods, their arguments and exceptions are those of :class:`odkit.Client`; calls run one after the other, on a
    thread of the client. A cancelled call ends at once; the client aborts its SDO transfer.
    """

    def __init__(self, link: Any, *, timeout: float = 1.0) -> None:
        self._client = Client(link, timeout=timeout)
        self._thread = ThreadPoolExecutor(1, "odkit.AsyncClient")

    async def __aenter__(self) -> AsyncClient:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Closes the link, after the calls that wait."""
        await self._run(self._client.close)
        self._thread.shutdown(wait=False)

    async def _run(self, call: Callable[..., _T], *args: Any, **keywords: Any) -> _T:
        job = _Job(self._client, functools.partial(call, *args, **keywords))
        try:
            return await asyncio.get_running_loop().run_in_executor(self._thread, job)
        except asyncio.CancelledError:
            job.end()
            raise

    def __getattr__(self, name: str) -> Callable[..., Coroutine[Any, Any, Any]]:
        method = getattr(self._client, name)
        if not callable(method) or name in ("node", "interrupt"):
            raise AttributeError(f"an AsyncClient has no {name}")

        @functools.wraps(method)
        async def call(*args: Any, **keywords: Any) -> Any:
            return await self._run(method, *args, **keywords)

        return call

    async def describe(self, node_id: int, eds: Any) -> Node:
        """Gives a node its description, as :meth:`odkit.Client.node` does: values have types and names from then on."""
        return await self._run(self._client.node, node_id, eds)

    async def lost(self) -> list[int]:
        """Node IDs of the monitored nodes whose heartbeat is missing."""
        return await self._run(lambda: self._client.lost)

    def __repr__(self) -> str:
        return f"<odkit.AsyncClient of {self._client!r}>"


class _Job:
    """A call on the thread of a client, which another thread can end."""

    def __init__(self, client: Client, call: Callable[[], Any]) -> None:
        self._client = client
        self._call = call
        self._lock = threading.Lock()
        self._runs = False
        self._has_ended = False

    def __call__(self) -> Any:
        with self._lock:
            if self._has_ended:
                return None
            self._client.interrupt(False)
            self._runs = True
        try:
            return self._call()
        finally:
            with self._lock:
                self._runs = False

    def end(self) -> None:
        """Ends the call, or keeps it from beginning."""
        with self._lock:
            self._has_ended = True
            if self._runs:
                self._client.interrupt()
