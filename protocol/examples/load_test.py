"""load_test.py [VIEWERS [SECONDS]] URL: viewers of one session, each with its own connection.

Prints the frames per second of a viewer, and the longest time of a reply. The viewers acknowledge
frames without decoding them.
"""

import statistics
import sys
import threading
import time

from vat import Client, frame_number

PERIOD = 0.25  # of each viewer's requests [s]


class Viewer(threading.Thread):
    def __init__(self, url, session, seconds):
        super().__init__()
        self.url, self.session, self.seconds = url, session, seconds
        self.frames, self.bytes, self.longest_reply = 0, 0, 0.0

    def run(self):
        with Client(self.url) as client:
            client.call("session.join", session=self.session)
            client.call("frames.subscribe", max_error=0.001)
            request = time.monotonic()
            end = request + self.seconds
            while (now := time.monotonic()) < end:
                if now >= request:
                    client.call("session.hash")
                    self.longest_reply = max(self.longest_reply, time.monotonic() - now)
                    request += PERIOD
                data = client.next_frame_bytes()
                client.notify("frames.ack", number=frame_number(data))
                self.frames, self.bytes = self.frames + 1, self.bytes + len(data)


def main():
    *numbers, url = sys.argv[1:]
    count, seconds = int((numbers or [8])[0]), float((numbers + [0, 5])[1] or 5)
    with Client(url) as owner:
        session = owner.call("session.create", name="load test", scene="dam-break")["session"]
        owner.call("session.join", session=session)
        owner.call("control.play")
        viewers = [Viewer(url, session, seconds) for _ in range(count)]
        for act in (Viewer.start, Viewer.join):
            for viewer in viewers:
                act(viewer)
        owner.call("session.close", session=session)
    rates = [viewer.frames / seconds for viewer in viewers]
    print(f"{count} viewers: {statistics.mean(rates):.1f} frames/s (least {min(rates):.1f}),",
          f"{sum(v.bytes for v in viewers) / seconds / 1000:.0f} kB/s in all,",
          f"longest reply {1000 * max(v.longest_reply for v in viewers):.0f} ms")


if __name__ == "__main__":
    main()
