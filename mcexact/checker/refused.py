"""The end of a check that is not VALID, which every step may bring about."""


class Refused(Exception):
    """The end of a check that is not VALID: a verdict, a code, a place and a message."""

    def __init__(self, verdict: str, code: str, place: str, message: str) -> None:
        super().__init__(verdict, code, place, message)
        self.verdict, self.code, self.place, self.message = verdict, code, place, message
