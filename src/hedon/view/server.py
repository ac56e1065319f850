"""The local server of `hedon view`: read-only, for this machine, and limited to the files that the page needs.

Every link starts with a random token, so that other users, programs and pages that know the port get nothing. For a
port that the user chose, the token is kept in a file that only they can read, so that links survive a restart. The
server has a list of names, and returns the file or data for a name; it never builds a path from a request.
"""

import secrets
from collections.abc import Callable, Mapping
from contextlib import suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import Any, cast
from urllib.parse import urlsplit

from hedon.error import HedonError
from hedon.view.compressed import Compressed, takes_gzip
from hedon.view.page import CONTENT_TYPES, page_files, to_json
from hedon.view.token import fresh_token, kept_token

LOOPBACK = "127.0.0.1"
HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; "
        "style-src 'self'; font-src 'self'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'"
    ),
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Embedder-Policy": "require-corp",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
    "Vary": "Accept-Encoding",
}

Data = Mapping[str, Callable[[], Any]]
"""Functions that return the data of the page, by name; called at each request, since a run may be in progress."""
Files = Callable[[], Mapping[str, Path]]
"""The records that the page may read, by name."""


class Server(ThreadingHTTPServer):
    """Serves the page on a port of this machine.

    Args:
        data: Data of the page, served as `data/<name>.json`.
        records: Records that the page may read, served as `data/run/<name>`.
        port: Port to use; 0 for any free one, with a new token. A chosen port always uses the token of this user.
    """

    daemon_threads = True

    def __init__(self, data: Data, records: Files, port: int = 0) -> None:
        self.data = data
        self.records = records
        self.page = page_files()
        self.compressed = Compressed()
        self.token = kept_token() if port else fresh_token()
        super().__init__((LOOPBACK, port), _Handler)
        self.hosts = {f"{name}:{self.server_port}" for name in (LOOPBACK, "localhost")}

    @property
    def link(self) -> str:
        """The address of the page."""
        return f"http://{LOOPBACK}:{self.server_port}/{self.token}/"

    def find(self, path: str) -> tuple[str, bytes] | None:
        """The type and content for the path of a link; None for a wrong token or a wrong name alike."""
        token, slash, name = path.removeprefix("/").partition("/")
        if not slash or not secrets.compare_digest(token.encode(), self.token.encode()):
            return None
        name = name or "index.html"
        if name.startswith("data/run/"):
            return _content(name, self.records().get(name.removeprefix("data/run/")))
        if name.startswith("data/") and name.endswith(".json"):
            provider = self.data.get(name.removeprefix("data/").removesuffix(".json"))
            return None if provider is None else (CONTENT_TYPES[".json"], to_json(provider()))
        return _content(name, self.page.get(name))


def _content(name: str, path: Path | None) -> tuple[str, bytes] | None:
    if path is None or path.is_symlink():
        return None
    return CONTENT_TYPES.get(PurePosixPath(name).suffix, "application/octet-stream"), path.read_bytes()


class _Handler(BaseHTTPRequestHandler):
    server_version = "hedon"
    sys_version = ""

    def do_HEAD(self) -> None:
        self.do_GET()

    def do_GET(self) -> None:
        # Another site could make its own name resolve to this machine (DNS rebinding); the host is then that name.
        server = cast(Server, self.server)
        if self.headers.get("Host") not in server.hosts:
            return self._answer(HTTPStatus.FORBIDDEN, "text/plain", b"wrong host\n")
        try:
            path = urlsplit(self.path).path
        except ValueError:
            return self._answer(HTTPStatus.BAD_REQUEST, "text/plain", b"no such address\n")
        try:
            answer = server.find(path)
        except (HedonError, OSError) as error:
            return self._answer(HTTPStatus.CONFLICT, "text/plain; charset=utf-8", f"{error}\n".encode())
        if answer is None:
            return self._answer(HTTPStatus.NOT_FOUND, "text/plain", b"not found\n")
        content_type, content = answer
        packed = server.compressed.pack(path, content) if takes_gzip(self.headers.get("Accept-Encoding", "")) else None
        if packed is None:
            return self._answer(HTTPStatus.OK, content_type, content)
        return self._answer(HTTPStatus.OK, content_type, packed, {"Content-Encoding": "gzip"})

    def handle(self) -> None:
        """Answers until the page closes the connection, which it may do in the middle of an answer."""
        with suppress(ConnectionError, TimeoutError):
            super().handle()

    def finish(self) -> None:
        with suppress(ConnectionError, ValueError):  # unsent data are dropped
            super().finish()

    def _answer(
        self,
        status: HTTPStatus,
        content_type: str,
        content: bytes,
        extra_headers: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self.send_response(status)
        length = {"Content-Type": content_type, "Content-Length": str(len(content))}
        for name, value in {**HEADERS, **length, **extra_headers}.items():
            self.send_header(name, value)
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(content)

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002
        """Logs nothing, to keep the terminal readable."""
