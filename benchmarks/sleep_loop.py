"""A bare loop at sixty deadlines a second: `python sleep_loop.py SECONDS` prints each lateness [s]."""

import json
import sys
import time

RATE_HZ = 60


def main(seconds: float) -> None:
    """Sleep until absolute deadlines and print the lateness as JSON."""
    start = time.monotonic()
    late = []
    for k in range(1, int(seconds * RATE_HZ)):
        deadline = start + k / RATE_HZ
        time.sleep(max(deadline - time.monotonic(), 0.0))
        late.append(max(time.monotonic() - deadline, 0.0))
    print(json.dumps(late))


if __name__ == "__main__":
    main(float(sys.argv[1]))
