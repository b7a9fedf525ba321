"""The part of a frame after its header: FRAMES.md, "Symbols" and "Residuals"."""

import struct
from bisect import bisect_right

from bad_frame import BadFrame
from residual_tables import LARGEST_CLASS, RADIUS, STARTS, table_of

LOWEST_STATE = 1 << 15
STATES = struct.Struct("<3I")
WORD = struct.Struct("<H")


def split(prediction: int) -> tuple[int, int]:
    """Returns the integer part of a prediction in eighths, and its fraction."""
    whole = (prediction + 4) >> 3
    return whole, prediction - 8 * whole


class Symbols:
    """Reads symbols from three lanes that share one stream of words."""

    def __init__(self, stream: bytes) -> None:
        if len(stream) < STATES.size:
            raise BadFrame("truncated")
        self.states = list(STATES.unpack_from(stream))
        if not all(LOWEST_STATE <= state < 1 << 31 for state in self.states):
            raise BadFrame("bad_block")
        self.stream = stream
        self.place = STATES.size

    def finish(self) -> None:
        """Checks the rules for the data after the last symbol."""
        if self.place != len(self.stream):
            raise BadFrame("extra_bytes")
        if any(state != LOWEST_STATE for state in self.states):
            raise BadFrame("bad_block")

    def check_count(self, count: int) -> int:
        """Returns a count. Raises BadFrame if the symbols cannot contain this number of items."""
        if count > 8 * len(self.stream):
            raise BadFrame("bad_block")
        return count

    def take(self, start: int, frequency: int, lane: int) -> None:
        """Removes the symbol with this range of cases from a lane."""
        state = self.states[lane]
        state = frequency * (state >> 12) + state % 4096 - start
        if state < LOWEST_STATE:
            if self.place + WORD.size > len(self.stream):
                raise BadFrame("truncated")
            state = (state << 16) + WORD.unpack_from(self.stream, self.place)[0]
            self.place += WORD.size
        self.states[lane] = state

    def bits(self, n: int, lane: int = 0) -> int:
        if n == 0:
            return 0
        value = self.states[lane] % 4096 >> (12 - n)
        self.take(value << (12 - n), 1 << (12 - n), lane)
        return value

    def long(self, n: int, lane: int = 0) -> int:
        value = 0
        for shift in range(0, n, 12):
            value += self.bits(min(n - shift, 12), lane) << shift
        return value

    def flag(self, cases: int) -> bool:
        value = self.states[0] % 4096 < cases
        if value:
            self.take(0, cases, 0)
        else:
            self.take(cases, 4096 - cases, 0)
        return value

    def whole(self, lane: int = 0) -> int:
        n = self.bits(6, lane)
        if n > 32:
            raise BadFrame("bad_block")
        return 0 if n == 0 else (1 << (n - 1)) + self.long(n - 1, lane)

    def signed(self) -> int:
        v = self.whole()
        value = -(v // 2) if v % 2 else v // 2
        if abs(value) > 1 << 28:
            raise BadFrame("bad_block")
        return value

    def factor(self) -> int:
        """Reads a factor in 256ths."""
        return self.bits(11) - 1024

    def residual_class(self) -> int:
        value = self.bits(7)
        if value > LARGEST_CLASS:
            raise BadFrame("bad_block")
        return value

    def residual(self, residual_class: int, fraction: int, lane: int) -> int:
        table, low_bits = table_of(residual_class)
        starts = STARTS[table][1 if abs(fraction) >= 2 else 0]
        symbol = bisect_right(starts, self.states[lane] % 4096) - 1
        self.take(starts[symbol], starts[symbol + 1] - starts[symbol], lane)
        h = symbol - RADIUS[table]
        if h > RADIUS[table]:
            negative = self.bits(1, lane) == 1
            beyond = self.whole(lane)
            if beyond >= 1 << (30 - low_bits):
                raise BadFrame("bad_block")
            h = RADIUS[table] + 1 + beyond
            if negative:
                h = -h
        r = (h << low_bits) + self.bits(low_bits, lane)
        return -r if fraction < 0 else r

    def predicted(self, prediction: int, residual_class: int, lane: int) -> int:
        """Reads a value that was predicted in eighths."""
        whole, fraction = split(prediction)
        return whole + self.residual(residual_class, fraction, lane)
