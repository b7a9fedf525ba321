"""Compares the decoded frames of tests/golden with their stored values, and damaged frames with
their errors.
"""

import functools
import json
import re
import sys
import unittest
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "protocol" / "python" / "reference"))

from bad_frame import BadFrame
from blocks import Block, ParticleBlock
from decode_frame import Decoder, Frame
from symbols import Symbols

FRAMES = ROOT / "tests" / "golden" / "frames"
KINDS = ("liquid", "deformable", "rigid", "vat")


def frame_bytes(name: str) -> bytes:
    return (FRAMES / f"{name}.bin").read_bytes()


def decoder_after(names: list[str]) -> Decoder:
    decoder = Decoder()
    for name in names:
        decoder.decode(frame_bytes(name))
    return decoder


class Trace:
    """Lists the outermost symbols that a decoder reads, as (symbol in FRAMES.md, value)."""

    NAMES = {"residual_class": "class"}

    def __init__(self, case: unittest.TestCase) -> None:
        self.rows: list[tuple[str, str]] = []
        self.depth = 0
        for name in ("bits", "long", "flag", "whole", "signed", "factor", "residual_class",
                     "residual"):
            original = getattr(Symbols, name)
            case.addCleanup(setattr, Symbols, name, original)
            setattr(Symbols, name, self.traced(name, original))

    def traced(self, name: str, original: Any) -> Any:
        @functools.wraps(original)
        def read(symbols: Symbols, *arguments: int) -> Any:
            self.depth += 1
            value = original(symbols, *arguments)
            self.depth -= 1
            if self.depth == 0:
                lane = f", lane {arguments[2]}" if name == "residual" else ""
                shown = ", ".join(map(str, arguments[:2]))
                text = str(value).lower() if isinstance(value, bool) else str(value)
                self.rows.append((f"{self.NAMES.get(name, name)}({shown}){lane}", text))
            return value

        return read


def block_as_json(block: Block) -> dict[str, Any]:
    shown: dict[str, Any] = {"body": block.body, "kind": KINDS[block.kind]}
    if isinstance(block, ParticleBlock):
        shown["numbers"] = block.numbers
        shown["grid_positions"] = [x for position in block.positions for x in position]
        shown["attributes"] = block.attributes
        return shown
    shown["place"] = block.place
    if block.orientation:
        shown["orientation_bits"] = block.orientation_bits
        shown["orientation"] = block.orientation
    return shown


def frame_as_json(frame: Frame) -> dict[str, Any]:
    header, scale = frame.header, frame.scale
    return {
        "header": {
            "playing": header.playing,
            "slow": header.slow,
            "detail": header.detail,
            "region": header.region,
            "stride": header.stride,
            "epoch": header.epoch,
            "number": header.number,
            "tick": header.tick,
            "time": header.time,
            "published": header.published,
            "real_time_factor": header.real_time_factor,
            "origin": list(scale.origin),
            "quantum": scale.quantum,
            "attribute_quanta": list(scale.attribute_quanta),
        },
        "blocks": [block_as_json(block) for block in frame.blocks],
    }


def damaged(case: dict[str, Any]) -> bytes:
    frame = frame_bytes(case["base"])
    frame = frame[:case.get("keep", len(frame))] + bytes.fromhex(case.get("append", ""))
    if patch := case.get("patch"):
        new = bytes.fromhex(patch["bytes"])
        frame = frame[:patch["offset"]] + new + frame[patch["offset"] + len(new):]
    return frame


class GoldenFrames(unittest.TestCase):
    def test_good_ones(self) -> None:
        names = sorted(path.stem for path in FRAMES.glob("*.bin"))
        self.assertGreater(len(names), 0)
        for name in names:
            with self.subTest(name):
                expected = json.loads((FRAMES / f"{name}.json").read_text())
                decoder = decoder_after(expected.pop("after"))
                self.assertEqual(frame_as_json(decoder.decode(frame_bytes(name))), expected)

    def test_damaged_ones(self) -> None:
        cases = json.loads((FRAMES / "bad.json").read_text())
        self.assertGreater(len(cases), 0)
        for case in cases:
            with self.subTest(case["name"], base=case["base"]):
                decoder = decoder_after(case["after"])
                kept = list(decoder.frames)
                with self.assertRaises(BadFrame) as refused:
                    decoder.decode(damaged(case))
                self.assertEqual(refused.exception.reason, case["error"])
                self.assertEqual(decoder.frames, kept)

    def test_read_the_symbols_of_the_documented_examples(self) -> None:
        document = (ROOT / "protocol" / "FRAMES.md").read_text("utf-8")
        decoder = Decoder()
        trace = Trace(self)
        for name in ("v2-twice", "v2-twice-one"):
            trace.rows.clear()
            decoder.decode(frame_bytes(name))
            table = document.split(f"<!-- begin {name} -->")[1].split("<!-- end")[0]
            rows = re.findall(r"^\| (\S.*?\).*?) \| (\S+) \|", table, re.MULTILINE)
            self.assertEqual(rows, trace.rows)


if __name__ == "__main__":
    unittest.main()
