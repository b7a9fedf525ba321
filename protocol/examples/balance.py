"""balance.py URL: an environment with reset() and step() of Gymnasium, and a controller."""

import math
import sys

from vat import Client

TICKS = 5  # of 0.02 s, for each action
SCENE = {
    "format": "vat.scene/1", "materials": [{"name": "steel", "density": 7800}],
    "vat": {"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 0.5]},
    "bodies": [{"name": "ball", "kind": "rigid", "material": "steel", "spacing": 0.05,
                "shape": {"type": "sphere", "radius": 0.05}, "position": [0.3, -0.2, 0.05]}],
}


class Table:
    """Observation: the ball's (x, y, vx, vy). Action: tilt along x and y [rad]. Reward: -distance."""

    def __init__(self, url):
        self.client = Client(url)
        session = self.client.call("session.create", name="table", scene=SCENE)["session"]
        self.client.call("session.join", session=session)
        self.client.call("control.pause")

    def observe(self):
        ball = self.client.call("state.query", bodies=["ball"])["bodies"][0]
        return (*ball["center_of_mass"][:2], *ball["velocity"][:2])

    def reset(self):
        self.client.call("control.reset")
        return self.observe(), {}

    def step(self, action):
        x, y = (9.81 * math.sin(tilt) for tilt in action)
        self.client.call("world.set_gravity", gravity=[x, y, -9.81])
        self.client.call("control.step", ticks=TICKS)
        seen = self.observe()
        distance = math.hypot(*seen[:2])
        return seen, -distance, False, False, {"distance": distance}


def main():
    table = Table(sys.argv[1])
    first, _ = table.reset()
    seen, total = first, 0
    for _ in range(60):  # 6 s
        x, y, vx, vy = seen
        action = [max(-0.2, min(0.2, -0.4 * p - 0.3 * v)) for p, v in ((x, vx), (y, vy))]
        seen, reward, *_, info = table.step(action)
        total += reward
    print("within 1 cm of the middle:", info["distance"] < 0.01)
    print("mean reward above -0.1:", total / 60 > -0.1)
    print("the same start after a reset:", table.reset()[0] == first)
    table.client.close()


if __name__ == "__main__":
    main()
