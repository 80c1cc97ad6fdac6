"""`halfrow-labgrid`: holds a place of labgrid's for halfrow's production station.

    halfrow-labgrid hold --place NAME --coordinator HOST:PORT --user USER

acquires the place, prints one line of JSON and waits until its stdin ends or SIGTERM comes; then it releases the place. So a place is released
when whoever started this is gone, however it went. `free` releases what the same USER left acquired.
"""
from __future__ import annotations

import argparse
import asyncio
import json
import logging
import os
import signal
import sys
import threading

import attr

from .place import Coordinator, Refused, ended_by, held


def arguments() -> argparse.Namespace:
    head, _, rest = (__doc__ or "").partition("\n\n")
    parser = argparse.ArgumentParser(
        "halfrow-labgrid", description=head, epilog=rest, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("act", choices=["hold", "free"])
    parser.add_argument("--place", required=True, help="the place's whole name")
    parser.add_argument("--coordinator", default=os.environ.get("LG_COORDINATOR", "127.0.0.1:20408"), metavar="HOST:PORT")
    parser.add_argument("--user", required=True, help="who has the place, as labgrid shows it")
    return parser.parse_args()


SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)


def heed(loop: asyncio.AbstractEventLoop) -> None:
    """Has the first signal end what the loop waits for by SystemExit, and so what is held be given back; others change nothing then.

    A signal outside the loop is heeded when the loop goes on, hence never between an acquisition and its guard.
    """

    def end(number: int) -> None:
        for each in SIGNALS:
            loop.add_signal_handler(each, lambda: None)
        sys.exit(128 + number)

    for number in SIGNALS:
        loop.add_signal_handler(number, end, number)


def tell(**said: object) -> None:
    print(json.dumps(said), flush=True)


def wait(loop: asyncio.AbstractEventLoop) -> None:
    """Waits until stdin ends or a signal ends this process. labgrid's session goes on meanwhile."""
    over = asyncio.Event()

    def read() -> None:
        # Not through sys.stdin: while it waits, nobody else can get its lock.
        while os.read(0, 4096):
            pass
        loop.call_soon_threadsafe(over.set)

    for number in SIGNALS:
        loop.add_signal_handler(number, over.set)
    threading.Thread(target=read, daemon=True).start()
    loop.run_until_complete(over.wait())


def act(of: argparse.Namespace) -> None:
    coordinator = Coordinator(of.coordinator, of.user)
    heed(coordinator.loop)
    with ended_by(coordinator.close):
        if of.act == "free":
            coordinator.free(of.place)
            print('"freed"', flush=True)
            return
        with held(coordinator, of.place) as port:
            tell(held=attr.asdict(port))
            wait(coordinator.loop)


def main() -> None:
    # Apart from its errors, labgrid's log is of no use to a program.
    logging.basicConfig(level=logging.CRITICAL)
    try:
        act(arguments())
    except Refused as refused:
        tell(refused={"why": refused.why, **refused.details})
        sys.exit(1)
