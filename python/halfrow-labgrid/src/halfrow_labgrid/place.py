"""A labgrid place that is acquired for as long as its holder wants it, and the serial port in it."""
from __future__ import annotations

import asyncio
import os
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any, Callable, Iterator, Mapping, Optional, Tuple

import attr
import grpc
from labgrid import Target, target_factory
from labgrid.remote.client import ClientSession, Error, ensure_event_loop
from labgrid.remote.common import Place, ResourceEntry
from labgrid.remote.generated import labgrid_coordinator_pb2 as messages
from labgrid.util.proxy import proxymanager

# How long the coordinator may take to answer, in seconds.
PATIENCE = 10.0
# How long an exporter may take to open the port of an acquired place, in seconds.
PORT_PATIENCE = 10.0
LOOK = 0.05

PORT = "NetworkSerialPort"
# The name of the port to use if a place has several.
NAMED = "halfrow"

# The answers with which the coordinator has not acquired the place. After any other error it may have.
DENIED = {grpc.StatusCode.INVALID_ARGUMENT, grpc.StatusCode.FAILED_PRECONDITION, grpc.StatusCode.PERMISSION_DENIED}


@attr.s(auto_attribs=True, frozen=True, auto_exc=True)
class Refused(Exception):
    """Why a place cannot be held: `why` is a word for programs, `details` are its figures and names."""

    why: str
    details: Mapping[str, str] = {}


@attr.s(auto_attribs=True, frozen=True)
class Port:
    """Where the port of a place is; `speed` is in baud, if its exporter gives one."""

    host: str
    port: int
    speed: Optional[int]


class Coordinator:
    """A session with labgrid's coordinator, under the name of `user` on this computer."""

    def __init__(self, address: str, user: str) -> None:
        # labgrid's session takes its name from this variable.
        os.environ["LG_USERNAME"] = user
        self.loop = ensure_event_loop()
        self._address = address
        self._session = ClientSession(proxymanager.get_grpc_address(address, default_port=20408), self.loop)
        self.name = f"{self._session.gethostname()}/{self._session.getuser()}"
        try:
            self._wait(self._session.start())
        except Refused:
            # The request is still pending, and would cause a complaint when the program ends.
            self.close()
            raise

    def _wait(self, asked: Any) -> Any:
        try:
            return self.loop.run_until_complete(asyncio.wait_for(asked, PATIENCE))
        except (Error, asyncio.TimeoutError) as error:
            raise Refused("coordinator-away", {"coordinator": self._address}) from error

    def close(self) -> None:
        """Ends the session. Places stay acquired."""
        self._session.stopping.set()
        self._wait(self._session.stop())
        self._wait(self._session.close())

    def _place(self, name: str) -> Place:
        # labgrid's own look-up also accepts a part of a name.
        try:
            return self._session.places[name]
        except KeyError:
            raise Refused("unknown", {"known": ", ".join(sorted(self._session.places))}) from None

    def acquire(self, name: str) -> None:
        """Acquires the place. If this same user still has it, since an earlier hold ended without a release, acquires it anew.

        On failure the place is not left acquired, as far as the coordinator answers.
        """
        place = self._place(name)
        if place.acquired == self.name:
            self.release(name)
        if place.acquired:
            raise Refused("held", {"holder": place.acquired})
        try:
            self._wait(self._session.stub.AcquirePlace(messages.AcquirePlaceRequest(placename=name)))
            self._wait(self._session.sync_with_coordinator())
        except grpc.aio.AioRpcError as error:
            if error.code() not in DENIED:
                self._give_back(name)
            raise Refused("not-acquired", {"said": error.details() or error.code().name}) from error
        except BaseException:
            self._give_back(name)
            raise

    def _give_back(self, name: str) -> None:
        """Releases the place after an error. Only that error is reported."""
        with suppress(Refused):
            self.release(name)

    def release(self, name: str) -> None:
        """Releases the place if this same user has it."""
        request = messages.ReleasePlaceRequest(placename=name, fromuser=self.name)
        try:
            self._wait(self._session.stub.ReleasePlace(request))
        except grpc.aio.AioRpcError as error:
            raise Refused("not-released") from error
        self._wait(self._session.sync_with_coordinator())

    def free(self, name: str) -> None:
        """Like release, but the place must exist."""
        self._place(name)
        self.release(name)

    def port(self, name: str) -> Port:
        """The raw port of the acquired place, once its exporter has opened it."""
        port: Port = self.loop.run_until_complete(self._port(self._place(name)))
        return port

    async def _port(self, place: Place) -> Port:
        for _ in range(round(PORT_PATIENCE / LOOK)):
            entry = self._entry(place)
            if entry.avail and entry.args.get("host") and entry.args.get("port"):
                return reached(entry)
            await asyncio.sleep(LOOK)
        raise Refused("port-away")

    def _entry(self, place: Place) -> ResourceEntry:
        # Not through labgrid's own table, in which a port hides another of the same name.
        ports = list(self._ports(place))
        named = [entry for name, entry in ports if name == NAMED]
        if len(named or ports) > 1:
            raise Refused("several-ports", {"ports": ", ".join(name for name, _ in ports)})
        for entry in named or [entry for _, entry in ports]:
            return entry
        raise Refused("no-port")

    def _ports(self, place: Place) -> Iterator[Tuple[str, ResourceEntry]]:
        """The ports of the acquired place, each with its name in that place."""
        for path in place.acquired_resources:
            exporter, group, cls, name = path
            if cls != PORT:
                continue
            try:
                entry = self._session.resources[exporter][group][name]
            except KeyError:
                raise Refused("port-away") from None
            yield place.getmatch(path).rename or f"{group}/{name}", entry


def reached(entry: ResourceEntry) -> Port:
    """Where a raw port can be reached from here, through labgrid's tunnel if it needs one."""
    resource = target_factory.make_resource(Target("halfrow"), entry.cls, None, entry.args)
    resource.extra = entry.extra
    if resource.protocol != "raw":
        raise Refused("protocol", {"protocol": resource.protocol})
    host, port = proxymanager.get_host_and_port(resource)
    return Port(host, port, entry.args.get("speed"))


@contextmanager
def ended_by(end: Callable[[], None]) -> Iterator[None]:
    """Calls `end` after the body, whatever happens. Of two errors, the first is reported."""
    try:
        yield
    except BaseException:
        with suppress(Refused):
            end()
        raise
    end()


@contextmanager
def held(coordinator: Coordinator, name: str) -> Iterator[Port]:
    """The port of the place, which is acquired for the body and released after it, whatever happens."""
    coordinator.acquire(name)
    with ended_by(partial(coordinator.release, name)):
        yield coordinator.port(name)
