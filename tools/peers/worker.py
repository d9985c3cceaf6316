"""The loop of a peer's worker: a scene is loaded once, then each request is rendered and timed."""

import json
import os
import sys
from types import SimpleNamespace

import numpy as np


def arguments():
    """SCENE WIDTH HEIGHT THREADS ENGINE VIEW IMAGE: view and environment where the scene has none, or null"""
    scene, width, height, threads, engine, view, image = sys.argv[1:8]
    return SimpleNamespace(
        scene=scene,
        width=int(width),
        height=int(height),
        threads=int(threads),
        engine=engine,
        view=json.loads(view),
        image=json.loads(image),
    )


def serve(start):
    """`start(arguments)` returns (description, least, render) with render(samples, seed) -> (image, seconds), where
    seconds are of rendering alone; `least` is the smallest number of samples a pixel that it does well.

    Requests and replies are JSON lines on stdin and stdout; what the peer itself prints goes to stderr.
    """
    replies = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)

    def reply(**values):
        replies.write(json.dumps(values) + "\n")

    try:
        description, least, render = start(arguments())
    except Exception as e:  # whatever a peer does not have or cannot do is a line in the report
        reply(error=f"{type(e).__name__}: {e}".splitlines()[0])
        return
    reply(ready=description, least=least)
    for line in sys.stdin:
        request = json.loads(line)
        try:
            image, seconds = render(request["samples"], request["seed"])
        except Exception as e:
            reply(error=f"{type(e).__name__}: {e}".splitlines()[0])
            continue
        np.save(request["file"], np.asarray(image, np.float32))
        reply(seconds=seconds)
    os._exit(0)  # some peers crash while they are unloaded
