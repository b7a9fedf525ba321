"""The error of a rejected frame, with a reason of the table in FRAMES.md, "Header"."""


class BadFrame(Exception):
    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason
