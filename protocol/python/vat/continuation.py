"""The data with which a client continues its session on another connection."""

from collections.abc import Generator, Sequence
from typing import Any

from vat.exchange import VatError
from vat.websocket import Closed

Request = tuple[str, dict[str, Any]]
Steps = Generator[Request, Any, None]  # yields requests, and receives their results

RECONNECT_TIME = 30.0  # [s]
FIRST_PAUSE = 0.1  # [s] between attempts; doubles up to the longest pause
LONGEST_PAUSE = 1.0
# Another attempt would have the same result: removed, or resumed by another connection.
FINAL_CODES = (4003, 4010)
FINAL_KINDS = ("no_such_session", "not_allowed", "not_authenticated", "invalid_params")


class Continuation:
    """Remembers the session, the tokens and the subscription of a client."""

    def __init__(self, urls: str | Sequence[str]) -> None:
        self.urls = [urls] if isinstance(urls, str) else list(urls)
        if not self.urls:
            raise ValueError("the list of URLs is empty")
        self.nodes: list[str] | None = None  #: URLs of the cluster; None: not asked yet
        self.token: str | None = None  #: of the last access.enter
        self.joined: dict[str, Any] | None = None  #: last result of session.join
        self._params: dict[str, Any] = {}  # of session.join
        self._subscription: dict[str, Any] | None = None
        self._turn = 0

    def next_url(self) -> str:
        """Returns the URLs in turn, each again and again."""
        urls = list(dict.fromkeys([*self.urls, *(self.nodes or [])]))
        self._turn += 1
        return urls[self._turn % len(urls)]

    def can_follow(self, error: BaseException | None) -> bool:
        """Returns whether the client may join its session again after this end of a connection."""
        is_final = isinstance(error, Closed) and error.code in FINAL_CODES
        return self.joined is not None and not is_final

    def remember(self, method: str, params: dict[str, Any], result: Any) -> None:
        """Notes a call that was successful."""
        if method == "session.join":
            if not result["resumed"]:
                self._subscription = None
            self._params = {name: params[name] for name in ("name", "role") if name in params}
            self.joined = result
        elif method == "session.leave":
            self.joined = self._subscription = None
        elif method == "frames.subscribe":
            self._subscription = params
        elif method == "frames.unsubscribe":
            self._subscription = None
        elif method == "access.enter":
            self.token = params["token"]

    def fail(self, error: VatError) -> None:
        """Raises the error of steps(), if another attempt would have the same result."""
        if error.kind in FINAL_KINDS:
            self.joined = None
            raise error

    def learn_nodes(self) -> Steps:
        """Asks for the nodes of the cluster, if they are unknown."""
        if self.nodes is None:
            self.nodes = (yield "server.info", {}).get("nodes", [])

    def enter(self) -> Steps:
        """Presents the token of the client, if it has one."""
        if self.token is not None:
            yield "access.enter", {"token": self.token}

    def steps(self) -> Steps:
        """Joins the session again, as the same participant if possible."""
        assert self.joined is not None
        info = yield "server.info", {}
        self.nodes = info.get("nodes", [])
        resume = self.joined["resume"]
        yield from self._enter_with(resume, info["access"] == "token")
        request = {**self._params, "session": self.joined["session"]}
        try:
            self.joined = yield "session.join", {**request, "resume": resume}
        except VatError as error:
            if error.kind != "not_authenticated" or self.token is None:
                raise
            yield from self.enter()  # the participant has left
            self.joined = yield "session.join", request
        if self._subscription is not None:
            yield "frames.subscribe", self._subscription

    def _enter_with(self, resume: str, needs_token: bool) -> Steps:
        if needs_token:
            try:
                yield "access.enter", {"token": resume}
                return
            except VatError as error:
                if error.kind != "not_authenticated" or self.token is None:
                    raise
        yield from self.enter()
