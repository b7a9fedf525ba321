"""lecture.py URL: a demonstration in parts. Each part starts when the lecturer presses Enter.

All students see the session at the printed address.
"""

import sys

from vat import Client

EARTH, MOON, SPACE = 9.81, 1.62, 0


def gravity(value):
    return lambda client: client.call("world.set_gravity", gravity=[0, 0, -value])


def reset(client):
    client.call("control.reset")


PARTS = [
    ("Three balls fall into water. One floats at half of its height: which one?", [reset]),
    ("The same on the moon. Does a ball sink deeper?", [reset, gravity(MOON)]),
    ("No: weight and buoyancy are both a sixth. And without gravity?", [gravity(SPACE)]),
    ("Nothing rises or sinks. Back on the earth:", [gravity(EARTH)]),
]
SECONDS = 1.5  # simulated time of each part


def show(client, actions):
    """Plays a part for viewers, in real time."""
    for action in actions:
        action(client)
    start = client.call("session.hash")["time"]
    client.call("control.play")
    while client.wait_event("session.status")["time"] < start + SECONDS:
        pass
    client.call("control.pause")


def main():
    url = sys.argv[1]
    with Client(url) as client:
        session = client.call("session.create", name="lecture", scene="buoyancy")["session"]
        client.call("session.join", session=session, name="Lecturer")
        client.call("control.pause")
        page = url.replace("ws", "http", 1).removesuffix("/ws")
        print(f"students open {page}/?session={session}", file=sys.stderr)
        for words, actions in PARTS:
            print(words, flush=True)
            sys.stdin.readline()
            show(client, actions)
        bodies = client.call("state.query")["bodies"][1:]  # without the water
        lowest = min(bodies, key=lambda body: body["center_of_mass"][2])
        print("deepest:", lowest["name"])


if __name__ == "__main__":
    main()
