"""A browser that shows a pyvista plotter by trame: what it says to the server in trame's own
protocol, and the pictures it gets."""

import asyncio
import io
import re

import aiohttp
import msgpack
import numpy as np
from PIL import Image
from wslink.chunking import UnChunker, generate_chunks

PICTURE = "viewport.image.push.subscription"
LARGEST = 2**24  # bytes of a message
PATIENCE = 20  # seconds; an answer that takes longer has failed
#: Seconds without a picture after which none is to come: trame sends one that was not encoded in
#: time after half a second.
QUIET = 1


class Browser:
    """A page with a plotter, for an `async with` statement."""

    def __init__(self, page):
        self._page = page
        self._calls = 0
        self._inbox = UnChunker()
        self._inbox.set_max_message_size(LARGEST)
        self.pictures = []

    async def __aenter__(self):
        host, plotter = re.fullmatch(r"(http://[^/]+)/index.html\?ui=(\w+).*", self._page).groups()
        self._session = aiohttp.ClientSession(timeout=aiohttp.ClientTimeout(total=60))
        async with self._session.get(self._page) as page:
            assert page.status == 200 and "trame" in await page.text()
        self._socket = await self._session.ws_connect(host + "/ws", max_msg_size=LARGEST)
        await self._call("wslink.hello", {"secret": "wslink-secret"}, name="system:c0:0")
        state = (await self._call("trame.state.get"))["state"]
        assert "vtk-remote-view" in state[f"trame__template_{plotter}"], (
            "the page has no view that the server renders"
        )
        self._view = state[f"view_{plotter}Id"]
        await self._call("viewport.image.push.observer.add", self._view)
        return self

    async def __aexit__(self, *_):
        await self._socket.close()
        await self._session.close()

    async def drag(self, *places):
        """Drag the left mouse button from place to place; each is two numbers from 0 to 1."""
        await self._mouse("down", places[0], 1)
        for place in places[1:]:
            await self._mouse("move", place, 1)
        await self._mouse("up", places[-1], 0)

    async def _mouse(self, action, place, pressed):
        keys = dict.fromkeys(
            ("buttonMiddle", "buttonRight", "shiftKey", "ctrlKey", "altKey", "metaKey"), 0
        )
        where = {"view": self._view, "x": place[0], "y": place[1]}
        await self._call(
            "viewport.mouse.interaction", {"action": action, "buttonLeft": pressed, **where, **keys}
        )

    async def last_picture(self):
        """Wait until no more pictures come; return the last one's colours [row, column, rgb]."""
        while True:
            try:
                await self._receive(QUIET)
            except asyncio.TimeoutError:
                assert self.pictures and not self.pictures[-1]["stale"], (
                    "there is no picture, or the last one is old"
                )
                return np.asarray(Image.open(io.BytesIO(self.pictures[-1]["image"])))

    async def _call(self, method, *arguments, name=None):
        self._calls += 1
        name = name or f"rpc:c0:{self._calls}"
        call = {
            "wslink": "1.0",
            "id": name,
            "method": method,
            "args": list(arguments),
            "kwargs": {},
        }
        for chunk in generate_chunks(msgpack.packb(call), LARGEST):
            await self._socket.send_bytes(chunk)
        while True:
            answer = await self._receive(PATIENCE)
            if answer["id"] == name:
                assert "error" not in answer, answer["error"]
                return answer["result"]

    async def _receive(self, seconds):
        """Return the next message, and keep it if it is a picture."""
        message = None
        while message is None:
            chunk = await self._socket.receive(timeout=seconds)
            assert chunk.type == aiohttp.WSMsgType.BINARY, f"the connection broke: {chunk}"
            message = self._inbox.process_chunk(chunk.data)
        if message["id"].startswith(f"publish:{PICTURE}:"):
            self.pictures.append(message["result"])
        return message
