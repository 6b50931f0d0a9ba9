#!/usr/bin/env python3
"""A winch holds the tension of its rope at 100 N while the pull at the other end grows: a loop over `sheave live`.

    examples/live_client.py [SHEAVE]      the command, if it is not on the path
"""

import json
import subprocess
import sys
import tempfile

SCENE = {
    "format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 6, "step": {"dt": 0.002},
    "bodies": [
        {"name": "drum", "mobility": "rotor", "mass": 5, "drive": "speed", "drive_values": [0],
         "shape": {"type": "cylinder", "radius": 0.2, "length": 0.4}},
        {"name": "boat", "mobility": "slider", "axis": [1, 0, 0], "mass": 200, "position": [10, 0.2, 0],
         "shape": {"type": "box", "size": [2, 1, 1]}}],
    "cables": [{"name": "rope", "compliance": 5e-5, "damping": 10, "links": [
        {"type": "spool", "body": "drum", "winding": "clockwise", "stored_length": 50},
        {"type": "attachment", "body": "boat"}]}]}


class World:
    """A world at the other end of two pipes."""

    def __init__(self, command, scene):
        self.process = subprocess.Popen([command, "live", scene], text=True, bufsize=1,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def ask(self, request, **settings):
        self.process.stdin.write(json.dumps({"type": request, **settings}) + "\n")
        answer = json.loads(self.process.stdout.readline())
        if not answer["ok"]:
            sys.exit("; ".join(fault["message"] for fault in answer["errors"]))
        return answer


def main():
    with tempfile.NamedTemporaryFile("w", suffix=".json") as scene:
        json.dump(SCENE, scene)
        scene.flush()
        world = World((sys.argv[1:] or ["sheave"])[0], scene.name)
        total, tension, time = 0.0, 0.0, 0.0
        while time < 6.0:
            pull = 100.0 + (20.0 * (time - 3.0) if time > 3.0 else 0.0)
            total += (tension - 100.0) * SCENE["step"]["dt"]
            speed = -(0.07 * (tension - 100.0) + 5.0 * total)
            world.ask("set", controls=[{"type": "force", "body": "boat", "force": [pull, 0, 0]},
                                       {"type": "speed", "body": "drum", "value": speed}])
            time = world.ask("step")["time"]
            tension = world.ask("observe", quantities=["rope.0.tension"])["values"]["rope.0.tension"]
        world.ask("quit")
        print(f"the tension is {tension:.2f} N")
        return 0 if abs(tension - 100.0) < 1.0 else 1


if __name__ == "__main__":
    sys.exit(main())
