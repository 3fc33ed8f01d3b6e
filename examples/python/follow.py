"""Follow a contact live: a row of CSV for each new state, whichever client moves it.

    python follow.py URL ID [STATES]

Needs `requests` and `pandas`. After a lost connection it continues with the next state; none is left out.
"""

import itertools
import json
import sys

import pandas
import requests


def states(service, contact, after=None):
    """The states of a contact as they come: the present one, or those after a sequence, and then each new one."""
    while True:
        headers = {} if after is None else {"Last-Event-ID": str(after)}
        url = f"{service}/contacts/{contact}/events"
        try:
            # The server sends a comment every 15 s: longer silence is a broken line.
            with requests.get(url, headers=headers, stream=True, timeout=60) as reply:
                reply.raise_for_status()
                kind = None
                for line in reply.iter_lines(chunk_size=1, decode_unicode=True):
                    name, _, value = line.partition(": ")
                    if name == "event":
                        kind = value
                    elif name == "data" and kind == "end":
                        return
                    elif name == "data":
                        event = json.loads(value)
                        after = event["sequence"]
                        yield {"sequence": after, "at": event["at"], **event["state"]}
        except (requests.ConnectionError, requests.Timeout, requests.exceptions.ChunkedEncodingError):
            continue


def table(service, contact, count):
    """The next so many states."""
    return pandas.DataFrame(itertools.islice(states(service, contact), count))


if __name__ == "__main__":
    service, contact = sys.argv[1:3]
    count = int(sys.argv[3]) if len(sys.argv) > 3 else None
    for index, state in enumerate(itertools.islice(states(service, contact), count)):
        row = pandas.DataFrame([state])[["sequence", "at", "displacement", "force", "stick_radius", "regime"]]
        print(row.to_csv(index=False, header=index == 0), end="", flush=True)
