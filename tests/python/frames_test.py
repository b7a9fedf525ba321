"""Compares the frames of vat.FrameDecoder with those of the decoder in protocol/python/reference."""

import sys
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import vat

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "protocol" / "python" / "reference"))

from decode_frame import Decoder  # type: ignore[import]

FRAMES = ROOT / "tests" / "golden" / "frames"
KINDS = ("liquid", "deformable", "rigid")
ATTRIBUTES = ("speed", "density", "pressure", "acceleration")


def frame_bytes(name: str) -> bytes:
    return (FRAMES / f"{name}.bin").read_bytes()


class Frames(unittest.TestCase):
    def compare_particles(self, body: vat.FrameBody, block: Any, scale: Any) -> None:
        assert body.positions is not None and body.numbers is not None
        np.testing.assert_array_equal(body.numbers, block.numbers)
        positions = np.array(scale.origin) + np.array(block.positions).reshape(-1, 3) * scale.quantum
        np.testing.assert_allclose(body.positions, positions, rtol=1e-15)
        for name, quantum, column in zip(ATTRIBUTES, scale.attribute_quanta, block.attributes):
            self.assertEqual(name in body.attributes, bool(column), name)
            if column:
                np.testing.assert_allclose(body.attributes[name], np.array(column) * quantum)

    def compare_pose(self, body: vat.FrameBody, block: Any, scale: Any) -> None:
        assert body.orientation is not None
        place = [start + half * scale.quantum / 2 for start, half in zip(scale.origin, block.place)]
        np.testing.assert_allclose(body.center_of_mass, place, rtol=1e-15)
        orientation = np.array(block.orientation)
        np.testing.assert_allclose(
            body.orientation, orientation / np.linalg.norm(orientation), rtol=1e-15)

    def compare(self, frame: vat.Frame, expected: Any) -> None:
        header = expected.header
        self.assertEqual((frame.number, frame.epoch, frame.tick, frame.time),
                         (header.number, header.epoch, header.tick, header.time))
        blocks = [block for block in expected.blocks if block.body != 0]
        for body, block in zip(frame.bodies, blocks, strict=True):
            self.assertEqual((body.id, body.kind), (block.body, KINDS[block.kind]))
            self.assertIs(frame[body.id], body)
            if body.kind == "rigid":
                self.compare_pose(body, block, expected.scale)
            else:
                self.compare_particles(body, block, expected.scale)
        if len(blocks) < len(expected.blocks):
            offset = [place * expected.scale.quantum for place in expected.blocks[0].place]
            np.testing.assert_allclose(frame.vat_offset, offset, rtol=1e-15)
        else:
            self.assertIsNone(frame.vat_offset)

    def test_golden_frames(self) -> None:
        compared = 0
        for key in sorted(FRAMES.glob("*key*.bin")):
            decoder, reference = vat.FrameDecoder(), Decoder()
            names = [key.stem]
            if key.stem == "v2-key":
                names += ["v2-delta-one", "v2-delta-two"]
            for name in names:
                with self.subTest(name):
                    data = frame_bytes(name)
                    self.compare(decoder.decode(data), reference.decode(data))
                    compared += 1
        self.assertGreaterEqual(compared, 3)

    def test_a_missing_reference(self) -> None:
        with self.assertRaises(vat.InputError) as raised:
            vat.FrameDecoder().decode(frame_bytes("v2-delta-one"))
        self.assertEqual(raised.exception.code, "missing_reference")

    def test_damaged_frames(self) -> None:
        key = frame_bytes("v2-key")
        for data in (b"", key[:20], key[:-1], b"x" + key[1:]):
            with self.assertRaises(vat.InputError):
                vat.FrameDecoder().decode(data)
        with self.assertRaisesRegex(ValueError, "incomplete"):
            vat.frame_number(key[:51])
        self.assertEqual(vat.frame_number(key), vat.FrameDecoder().decode(key).number)


if __name__ == "__main__":
    unittest.main()
