"""Structured mutants of the repository's scenes, through the command itself: for dev/fuzz mutants."""

import concurrent.futures
import copy
import json
import os
import pathlib
import random
import re
import resource
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
COMMAND = ROOT / "build" / "sanitize-all" / "tools" / "sheave"
# docs/explanation/reliability.md; `run` of a short time neither fails checks of its own accord nor is interrupted.
CONTRACT = {0, 1, 2, 65, 66, 74, 75, 76}
SECONDS = 10.0
NUMBERS = [0, -0.0, 1, -1, 0.5, 2, 10, 1e3, 1e-3, 1e6, 1e-6, 1e9, 1e-9, 1e15, 1e30, 1e-30, 1e100, -1e100, 1e300, -1e300, 1e308,
           5e-324, 2147483647, -2147483648, 4294967296, 1e17, 0.1, 3.141592653589793]
VALUES = [None, True, False, "", "world", "a", [], {}, [0, 0, 0], [1, 0, 0], [1e300, 0, 0], [1, 2], "x" * 300]
COMMENT = re.compile(r'"(?:[^"\\]|\\.)*"|//[^\n]*|/\*.*?\*/', re.DOTALL)


def load(path):
    text = COMMENT.sub(lambda m: m.group() if m.group().startswith('"') else "", path.read_text())
    return json.loads(text)


def scenes():
    """Every valid scene but those too large to be run thousands of times."""
    paths = sorted(p for p in (ROOT / "scenes").glob("*/*.json") if p.parent.name != "invalid")
    return [p for p in paths if p.stat().st_size < 40_000]


def places(value, path=()):
    """All (container, key) of a document, by their ways from the root."""
    keys = value.keys() if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()
    for key in keys:
        yield path + (key,)
        yield from places(value[key], path + (key,))


def at(document, path):
    for key in path:
        document = document[key]
    return document


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


class Mutator:
    def __init__(self, seed):
        self.random = random.Random(seed)

    def mutate(self, document):
        """A copy with one to three changes, as text; some cannot be told as a value, only as text."""
        document = copy.deepcopy(document)
        told = []
        for _ in range(self.random.choice((1, 1, 1, 2, 3))):
            all_places = [p for p in places(document) if p[0] not in ("format", "description", "checks")]
            if not all_places:
                break
            # Numbers are what most often leaves a scene that runs.
            numbers = [p for p in all_places if is_number(at(document, p))]
            chosen = numbers if numbers and self.random.random() < 0.7 else all_places
            told.append(self.change(document, self.random.choice(chosen), all_places))
        self.document = document
        text = json.dumps(document)
        if self.random.random() < 0.05:
            text, how = self.change_text(text)
            told.append(how)
        return text, "; ".join(told)

    def change(self, document, path, all_places):
        container, key = at(document, path[:-1]), path[-1]
        old = container[key]
        where = "/" + "/".join(map(str, path))
        way = self.random.random()
        number = is_number(old)
        if way < 0.08 and not number:
            del container[key]
            return f"{where} removed"
        if way < 0.12 and isinstance(container, list):
            container.insert(self.random.randint(0, len(container)), copy.deepcopy(old))
            return f"{where} repeated"
        if way < 0.15:
            container[key] = copy.deepcopy(self.random.choice(VALUES))
            return f"{where} = {container[key]!r}"
        if way < 0.25 or isinstance(old, str):
            same = [p for p in all_places if type(at(document, p)) is type(old) and p[-1] != "name"]
            if same:
                container[key] = copy.deepcopy(at(document, self.random.choice(same)))
                return f"{where} = {str(container[key])[:40]}"
        if number:
            container[key] = self.number(old)
            return f"{where} = {container[key]}"
        container[key] = copy.deepcopy(self.random.choice(VALUES))
        return f"{where} = {container[key]!r}"

    def number(self, old):
        way = self.random.random()
        if way < 0.4:
            return self.random.choice(NUMBERS)
        if way < 0.7:
            return old * self.random.choice((-1, 1e-6, 1e-3, 0.1, 0.5, 2, 10, 1e3, 1e6))
        return old + self.random.gauss(0, 1) * (abs(old) + 0.1)

    def change_text(self, text):
        members = [m for m in re.finditer(r'"\w+": [^,\[\]{}"]+', text)]
        if members and self.random.random() < 0.5:
            member = self.random.choice(members)  # a key twice
            return text[:member.start()] + member.group() + ", " + text[member.start():], "a key twice"
        i = self.random.randrange(len(text))
        return text[:i] + self.random.choice(["{", "}", "\0", "\xff", "1e999", "\\ud800", ","]) + text[i:], "text"


def bounded(step):
    """Options against runs that last because so many steps, substeps or rounds were asked for."""
    options = []
    if not isinstance(step, dict):
        return options
    for key, low, high, limit in (("dt", 0, 1e-3, "0.001"), ("substeps", 20, 100_000, "20"), ("iterations", 100, 1_000_000, "100")):
        if is_number(step.get(key)) and low < step[key] < high:
            options += ["--" + key, limit]
    return options


def command(path, document, mutator):
    """A tenth of a second of the scene, at most."""
    if mutator.random.random() < 0.1:
        return [str(COMMAND), "validate", "--json", path]
    arguments = [str(COMMAND), "run", path, "--duration", mutator.random.choice(("0.02", "0.1")), *bounded(document.get("step"))]
    if mutator.random.random() < 0.5:
        arguments += ["--solver", mutator.random.choice(("direct", "gauss-seidel"))]
    if mutator.random.random() < 0.5:
        arguments += ["--integrator", mutator.random.choice(("xpbd", "rattle"))]
    if mutator.random.random() < 0.5:
        arguments += ["--json"]
    if mutator.random.random() < 0.2:
        arguments += ["--strict"]
    return arguments


def limit_time():
    """What runs on and on is ended. It is the program's own time that counts, not what it waits for beside others."""
    most = int(6 * SECONDS)
    resource.setrlimit(resource.RLIMIT_CPU, (most, most))


def one(seed, documents, keep):
    mutator = Mutator(seed)
    path, document = mutator.random.choice(documents)
    text, told = mutator.mutate(document)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "mutant.json")
        file.write_bytes(text.encode("utf-8", "surrogateescape"))
        arguments = command(str(file), mutator.document, mutator)
        with open(pathlib.Path(folder, "out"), "w+b") as out_file, open(pathlib.Path(folder, "err"), "w+b") as err_file:
            process = subprocess.Popen(arguments, stdout=out_file, stderr=err_file, cwd=folder, preexec_fn=limit_time)
            _, status, usage = os.wait4(process.pid, 0)
            out_file.seek(0), err_file.seek(0)
            out, err = out_file.read(), err_file.read()
        process.returncode = code = os.waitstatus_to_exitcode(status)
        seconds = usage.ru_utime + usage.ru_stime
        if code not in CONTRACT:
            fault = f"exit code {code}"
        elif b"runtime error:" in err or b"AddressSanitizer" in err:
            fault = "a sanitizer's report"
        elif code not in (0, 1, 76) and not err.strip() and b"{" not in out:
            fault = f"exit code {code} without a word"
        else:
            fault = ""
        if fault or seconds > SECONDS:
            keep.mkdir(parents=True, exist_ok=True)
            (keep / f"mutant-{seed}.json").write_text(text, errors="surrogateescape")
    name = path.relative_to(ROOT)
    line = f"seed {seed}: {name}: {told}: {' '.join(arguments[1:2] + arguments[3:])}: {fault or 'slow'}, {seconds:.1f} s"
    return code, seconds, fault, line, err.decode(errors="replace")[-800:]


def run(count, first, jobs):
    """Returns a summary, and whether nothing was wrong."""
    if not COMMAND.is_file():
        raise SystemExit("fuzz: build the command first: cmake --build --preset sanitize-all --target sheave")
    documents = [(p, load(p)) for p in scenes()]
    keep = ROOT / "build" / "fuzz-faults" / "mutants"
    codes, faults, slow, longest = {}, 0, 0, 0.0
    start = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        results = pool.map(lambda s: one(s, documents, keep), range(first, first + count))
        for done, (code, seconds, fault, line, err) in enumerate(results, 1):
            if done % 1000 == 0:
                print(f"{done} mutants, {time.monotonic() - start:.0f} s", flush=True)
            codes[code] = codes.get(code, 0) + 1
            longest = max(longest, seconds)
            if fault:
                faults += 1
                print(line + "\n" + err, flush=True)
            elif seconds > SECONDS:
                slow += 1
                print(line, flush=True)
    summary = {"mutants": count, "scenes": len(documents), "codes": {str(c): n for c, n in sorted(codes.items())},
               "faults": faults, "slow": slow, "longest": round(longest, 1), "seconds": round(time.monotonic() - start)}
    return summary, faults == 0 and slow == 0


if __name__ == "__main__":
    import sys
    print(run(int(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])))
