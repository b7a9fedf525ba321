"""Why a frame is refused: a reason of the table in PROTOCOL.md, "The header"."""


class BadFrame(Exception):
    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason
