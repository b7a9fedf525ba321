"""fall.py URL: shows a ball that falls for half a second, in a separate session."""

import sys

from vat import Client, Frame, VatError

SCENE = {
    "format": "vat.scene/1",
    "materials": [{"name": "wood", "density": 600}],
    "bodies": [{"name": "ball", "kind": "rigid", "material": "wood", "spacing": 0.05,
                "shape": {"type": "sphere", "radius": 0.1}}],
}


def height(frame: Frame) -> float:
    """Returns the height of the only body."""
    return frame.bodies[0].center_of_mass[2]


def main() -> None:
    with Client(sys.argv[1]) as client:
        session = client.call("session.create", name="fall", scene=SCENE)["session"]
        joined = client.call("session.join", session=session)
        print("bodies:", ", ".join(body["name"] for body in joined["description"]["bodies"]))
        client.call("control.pause")
        client.call("control.reset")
        client.call("frames.subscribe", max_error=0.001, every=25)
        first = client.next_frame()
        print(f"tick {first.tick}: at {height(first):.2f} m")
        client.call("control.step", ticks=25)
        frame = client.next_frame()
        print(f"tick {frame.tick}: at {height(frame):.2f} m")
        try:
            client.call("world.remove_body", body=99)
        except VatError as error:
            print(f"{error.kind}: {error.data['hint']}")
        client.call("session.close", session=session)
        print("closed:", client.wait_event("session.closed")["session"] == session)


if __name__ == "__main__":
    main()
