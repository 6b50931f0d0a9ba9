"""The page bench/REPORT.md as text, from results of `sheave trade --json`. Every statement is made from their numbers."""

import math
import pathlib

LEVELS = [1e-2, 1e-3, 1e-4]
ASKED = 20.0  # times less that direct + rattle should cost


def number(value):
    """JSON has no NaN or infinity: they are null."""
    return math.nan if value is None else value


def digits(value, count=3):
    """Three digits, and never an exponent for what people read as a number."""
    if value is None or not math.isfinite(value):
        return "-"
    if value == 0.0:
        return "0"
    places = max(0, count - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{places}f}"


def error_text(error, doubt=0.0):
    """As sheave tells errors: "<" where the reference, or rounding, tells no more."""
    error, doubt = number(error), number(doubt)
    if math.isnan(error):
        return "-"
    if error > 3.0 * doubt and error > 1e-11:
        return f"{error:.1e}"
    return f"< {max(error + doubt, 1e-11):.1e}"


def percent(share):
    return f"{100.0 * share:g} %"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows] + [""]


class Scene:
    """What was measured of one scene."""

    def __init__(self, name, result):
        self.name, self.result = name, result
        self.fault = result.get("fault")
        rows = result.get("rows", [])
        self.rows = [row for row in rows if "error" in row]
        self.failed = [row for row in rows if "fault" in row]
        self.skipped = [row for row in rows if "skipped" in row]
        self.count = len(rows)
        reference = result.get("reference", {})
        self.doubt = number(reference.get("error_compared", {}).get("position"))
        self.motion = number(result.get("motion"))
        self.chaotic = reference.get("chaos_rate") is not None
        self.ladder = result.get("ladder") or {}

    def bound(self, row):
        return number(row["error"]["position"]) + self.doubt

    def error(self, row):
        return error_text(row["error"]["position"], self.doubt)

    def cheapest(self, level, solver=None, integrator=None):
        fit = [row for row in self.rows if self.bound(row) <= level and matches(row, solver, integrator)]
        return min(fit, key=cost, default=None)

    def best(self, solver, integrator):
        """The most accurate of a solver and integrator; of equally accurate ones the cheapest."""
        fit = [row for row in self.rows if matches(row, solver, integrator)]
        return min(fit, key=lambda row: (self.bound(row), cost(row)), default=None)

    def frame_ms(self, row):
        return 1e3 * cost(row) * row["settings"]["dt"]


def matches(row, solver, integrator):
    settings = row["settings"]
    return solver in (None, settings["solver"]) and integrator in (None, settings["integrator"])


def cost(row):
    return row["seconds_per_simulated_second"]["median"]


def solves(row):
    return row["row_solves_per_simulated_second"]


def ns_per_solve(row):
    return 1e9 * cost(row) / solves(row) if solves(row) > 0 else math.nan


def quartiles(spread):
    if spread["samples"] < 2:
        return "one sample"
    return f"{digits(1e3 * spread['lower_quartile'])} - {digits(1e3 * spread['upper_quartile'])}"


# ---------------------------------------------------------------- one scene


def scene_head(scene):
    result, reference = scene.result, scene.result["reference"]
    text = (f"{digits(result['simulated_seconds'])} s. Reference: direct, {reference['integrator']}, {reference['substeps']} substeps, "
            f"its own error {number(reference['error_compared']['position']):.1e}")
    if result["compared_seconds"] < result["simulated_seconds"]:
        text += f"; positions and tensions are compared for the first {digits(result['compared_seconds'])} s, until which it is known"
    if scene.chaotic:
        text += f"; **chaotic**, differences grow by e every {digits(1.0 / reference['chaos_rate'])} s"
    return text + "."


def choice_rows(scene):
    rows = []
    for level in LEVELS:
        row = scene.cheapest(level)
        if row is None:
            rows.append([percent(level), "none of these", "", "", "", ""])
            continue
        rows.append([percent(level), row["name"], digits(scene.frame_ms(row)), digits(1e3 * cost(row)),
                     quartiles(row["seconds_per_simulated_second"]), scene.error(row)])
    return rows


def saved(now, before):
    return f"{round(100.0 * (1.0 - now / before))} %" if before > 0 else "-"


def ladder_lines(scene):
    ladder = scene.ladder
    if "rungs" not in ladder:
        return [f"Model ladder: {ladder.get('skipped', 'not measured')}.", ""]
    rows = []
    for rung in ladder["rungs"]:
        name = f"{rung['name']} ({rung['things']}: {rung['changed']})"
        if "fault" in rung:
            rows.append([name, "not possible", "", "", ""])
            continue
        difference = rung["difference"]
        rows.append([name, error_text(difference["position"]), error_text(difference["tension"]),
                     saved(cost(rung), cost(ladder)), saved(solves(rung), solves(ladder))])
    faults = [f"* {rung['name']}: {rung['fault']}" for rung in ladder["rungs"] if "fault" in rung]
    if not rows:
        return ["Model ladder: there is nothing to leave out.", ""]
    head = [f"model, with {ladder['setting']}", "position", "tension", "time saved", "solves saved"]
    return table(head, rows) + faults + ([""] if faults else [])


def scene_lines(scene):
    lines = [f"### {scene.name}", ""]
    if scene.fault:
        return lines + [f"Not measured: {scene.fault}.", ""]
    lines += [scene_head(scene), "", f"![Errors over times of {scene.name}](report/{scene.name}.svg)", ""]
    lines += table(["position error", "cheapest setting", "ms / frame", "ms / s", "quartiles", "error"], choice_rows(scene))
    return lines + ladder_lines(scene)


# ---------------------------------------------------------------- direct + rattle against gauss-seidel + xpbd


def setting_cells(scene, row):
    return [row["name"], scene.error(row), digits(1e3 * cost(row)), f"{solves(row):.3g}"]


def gain_text(ratio, less="less"):
    """A ratio of costs in words."""
    return f"{digits(ratio)} times {less}" if ratio >= 1.0 else f"{digits(1.0 / ratio)} times more"


def causes_of(scene, direct, sweeps):
    """Why the ratio is less than what was asked for: few solves to save, or dear ones."""
    work = solves(sweeps) / solves(direct)
    causes = []
    if work < ASKED:
        causes.append(f"Gauss-Seidel with {sweeps['name'].split(' ', 1)[1]} is already accurate enough, so that there are few solves to save")
    if ns_per_solve(direct) > ns_per_solve(sweeps):
        causes.append("a solve of the direct solver, which assembles, factors and checks its rows and carries the fixed cost of a substep, "
                      f"takes {digits(ns_per_solve(direct) / ns_per_solve(sweeps))} times as long")
    return causes


def explanation(scene, measure, level, direct, sweeps, within):
    """The ratio as how many solves, times what each costs."""
    times, work = cost(sweeps) / cost(direct), solves(sweeps) / solves(direct)
    text = (f"* **{scene.name}**, {measure}: {gain_text(times)} time, with {gain_text(work, 'fewer')} row solves at "
            f"{digits(ns_per_solve(direct))} ns each instead of {digits(ns_per_solve(sweeps))} ns (all of the step's time, for each row solve).")
    if not within:
        skipped = sum(matches(row, "gauss-seidel", "xpbd") for row in scene.skipped)
        text += (f" The most accurate of {sum(matches(row, 'gauss-seidel', 'xpbd') for row in scene.rows)} gauss-seidel + xpbd settings that "
                 f"were run is still wrong by {scene.error(sweeps)} of the size" + (f"; {skipped} more expensive ones were skipped" if skipped else "")
                 + ".")
    if times < ASKED:
        text += f" Not {ASKED:g} times: " + "; and ".join(causes_of(scene, direct, sweeps)) + "."
        lighter = scene.cheapest(level, "direct", "xpbd")
        if lighter is not None and cost(lighter) < 0.9 * cost(direct):
            text += f" `direct` with `xpbd` ({lighter['name']}) takes {gain_text(cost(sweeps) / cost(lighter))} time than Gauss-Seidel."
    return text


def compared_row(scene, measure, level):
    """The cells, and what explains them."""
    direct = scene.cheapest(level, "direct", "rattle")
    sweeps = scene.cheapest(level, "gauss-seidel", "xpbd")
    within = sweeps is not None
    sweeps = sweeps or scene.best("gauss-seidel", "xpbd")
    if direct is None or sweeps is None:
        return [scene.name, measure, "none" if direct is None else direct["name"]] + [""] * 8, []
    ratio = digits(cost(sweeps) / cost(direct))
    mine, other = setting_cells(scene, direct), setting_cells(scene, sweeps)
    cells = [scene.name, measure] + mine + [other[0] + ("" if within else " (none is within)")] + other[1:]
    return cells + [ratio if within else "more than " + ratio], [explanation(scene, measure, level, direct, sweeps, within)]


def compared_lines(scenes, names):
    head = ["scene", "0.1 % of", "direct + rattle", "error", "ms / s", "solves / s", "best gauss-seidel + xpbd", "error", "ms / s", "solves / s",
            "times less"]
    rows, notes = [], []
    for scene in scenes:
        if scene.name not in names or scene.fault:
            continue
        measures = [("size", 1e-3)]
        if 0.0 < scene.motion < 1.0:
            measures.append((f"motion ({scene.motion:.1e} of the size)", 1e-3 * scene.motion))
        for measure, level in measures:
            cells, note = compared_row(scene, measure, level)
            rows.append(cells)
            notes += note
    if not rows:
        return []
    return (["## The paper's solver and this one at 0.1 %", "",
             "The cheapest settings whose position error is within 0.1 % in every frame: of the scene's size, and, where the bodies move by less "
             "than that, of the largest motion (root mean square over the bodies), because a long machine that hardly moves is within 0.1 % of its "
             f"size whatever one computes. Errors are relative to the size. Asked for: {ASKED:g} times less time. Where no setting of "
             "gauss-seidel + xpbd is within, the most accurate one stands here.", ""]
            + table(head, rows) + notes + [""])


# ---------------------------------------------------------------- over all scenes


def family(row):
    return f"{row['settings']['solver']} + {row['settings']['integrator']}"


def winners(scenes, level):
    """Families that have the cheapest setting for a level, with the scenes' names."""
    found = {}
    for scene in scenes:
        row = scene.cheapest(level)
        found.setdefault(family(row) if row else "none", []).append(scene.name)
    return found


def margin_rows(scenes, level):
    """How much more the other families cost than the cheapest."""
    rows = []
    for solver in ("gauss-seidel", "direct"):
        for integrator in ("xpbd", "rattle"):
            ratios = []
            for scene in scenes:
                best, own = scene.cheapest(level), scene.cheapest(level, solver, integrator)
                if best and own:
                    ratios.append(cost(own) / cost(best))
            missing = sum(1 for scene in scenes if scene.cheapest(level)) - len(ratios)
            ratios.sort()
            wins = sum(1 for ratio in ratios if ratio == 1.0)
            rows.append([f"{solver} + {integrator}", wins, digits(ratios[len(ratios) // 2]) if ratios else "-",
                         digits(ratios[-1]) if ratios else "-", missing])
    return rows


def tangents_line(scenes):
    """What tangents once per substep save, at the same setting, and what they cost in error."""
    pairs = []
    for scene in scenes:
        by_name = {row["name"]: row for row in scene.rows}
        for row in scene.rows:
            other = by_name.get(row["name"] + ", tangents per substep")
            if other and row["timed_alone"] and other["timed_alone"]:
                pairs.append((cost(other) / cost(row), scene.bound(other) / max(scene.bound(row), 1e-11)))
    if not pairs:
        return []
    times, errors = sorted(p[0] for p in pairs), sorted(p[1] for p in pairs)
    return [f"* **Tangents once per substep**, as in the paper, take {digits(times[len(times) // 2])} times the time of tangents in every "
            f"iteration (median of {len(pairs)} pairs of settings; {digits(times[len(times) // 10])} to {digits(times[-1 - len(times) // 10])} in "
            f"the middle four fifths), with {digits(errors[len(errors) // 2])} times the error."]


def rung_rows(scenes):
    found = {}
    for scene in scenes:
        for rung in scene.ladder.get("rungs", []):
            if "fault" not in rung:
                share = 1.0 - cost(rung) / cost(scene.ladder)
                difference = rung["difference"]
                tension = difference["tension"] or 0.0
                free = difference["position"] <= 1e-3 and tension <= 1e-2 and share >= 0.05
                found.setdefault(rung["name"], []).append((difference["position"], share, scene.name if free else ""))
    rows = []
    for name, entries in found.items():
        losses = sorted(entry[0] for entry in entries)
        shares = sorted(entry[1] for entry in entries)
        free = [entry[2] for entry in entries if entry[2]]
        rows.append([name, len(entries), error_text(losses[0]), error_text(losses[-1]), f"{round(100 * shares[0])} %", f"{round(100 * shares[-1])} %",
                     ", ".join(free)])
    return rows


def advice_lines(scenes):
    good = [scene for scene in scenes if not scene.fault and scene.rows]
    lines = ["## Recommendations", ""]
    for level in LEVELS:
        won = winners(good, level)
        parts = [f"`{name}` in {len(names)}" + (f" ({', '.join(names)})" if len(names) <= 6 else "")
                 for name, names in sorted(won.items(), key=lambda item: -len(item[1])) if name != "none"]
        lines.append(f"* **{percent(level)}**: of {len(good)} scenes the cheapest setting is " + ", ".join(parts)
                     + (f"; no setting reaches it in {', '.join(won['none'])}" if "none" in won else "") + ".")
    lines += tangents_line(good)
    lines += ["", "The cost of each pair at 0.1 %, over the cheapest setting of the scene:", ""]
    lines += table(["", "scenes in which it is cheapest", "median", "worst", "scenes in which it does not reach 0.1 %"], margin_rows(good, 1e-3))
    rungs = rung_rows(good)
    if rungs:
        lines += ["The next table shows the influence of each effect, over all scenes that have it: the difference of the motion from the unchanged scene, and "
                  "the saved time. The last column names the scenes where the change moves bodies by at most 0.1 % of the size and tensions by 1 %, and saves "
                  "5 % or more. There the effect can be left out.", ""]
        lines += table(["change of the model", "scenes", "position: least", "most", "time saved: least", "most", "worth it in"], rungs)
    return lines


def limit_lines(scenes):
    lines = ["## Limits", "",
             "* Errors are against a reference of the same model with smaller and smaller steps. So they are the errors of solver, integrator and step, "
             "and not those of the model. The error of the reference is added to every error before a setting is chosen.",
             "* Times are CPU times of one thread on the machine named above; the row solves are the same anywhere.",
             "* A setting that is twice as slow as another one with the same accuracy is timed once, in the run that gave its error."]
    for scene in scenes:
        if scene.fault:
            lines.append(f"* {scene.name}: not measured: {scene.fault}.")
            continue
        compared, simulated = scene.result["compared_seconds"], scene.result["simulated_seconds"]
        notes = []
        if compared < simulated:
            notes.append(f"the reference is known for the first {digits(compared)} of {digits(simulated)} s only")
        elif not scene.doubt <= 1e-4:
            notes.append(f"the reference's own error is {scene.doubt:.1e}")
        if scene.motion < 1e-9:
            notes.append("the bodies rest, so that errors tell how far they are pushed off, and nothing of motion")
        elif scene.motion < 0.1:
            notes.append(f"the bodies move by no more than {scene.motion:.1e} of the size, so that relative to their motion errors are "
                         f"{digits(1.0 / scene.motion)} times as large")
        if scene.failed:
            notes.append(f"{len(scene.failed)} of {scene.count} settings failed")
        if scene.skipped:
            notes.append(f"{len(scene.skipped)} of {scene.count} settings were skipped for want of time")
        notes += scene.result["limits"]
        missing = [percent(level) for level in LEVELS if scene.cheapest(level) is None]
        if missing:
            notes.append(f"no setting for {', '.join(missing)}")
        if notes:
            lines.append(f"* {scene.name}: {'; '.join(notes)}.")
    return lines + [""]


def stress_lines(text):
    """Of the table of maps on the page of sheave stress: all maps of a setting together."""
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]
    head = next((row for row in cells if "setting" in row and "cells" in row), None)
    if head is None:
        return []
    counted = head[head.index("cells"):]
    sums = {}
    for row in cells:
        found = dict(zip(head, row))
        if len(row) != len(head) or not found["cells"].isdigit():
            continue
        own = sums.setdefault(found["setting"], dict.fromkeys(counted, 0))
        for name in counted:
            own[name] += int(found[name]) if found[name].isdigit() else 0
    names = [name for name in counted if name != "worst error"]
    return table(["setting"] + names, [[setting] + [own[name] or "-" for name in names] for setting, own in sums.items()])


def other_lines(folder):
    """Pages that other commands have made, if they are there."""
    others = [("STRESS.md", "Where extreme numbers break machines", "sheave stress --markdown bench/STRESS.md"),
              ("SOAK.md", "10^7 steps: length, memory, determinism", "dev/soak")]
    lines = ["## Elsewhere", ""]
    for name, what, command in others:
        there = (pathlib.Path(folder) / name).exists()
        lines.append(f"* {what}: [{name}]({name})." if there else f"* {what}: not made yet, `{command}`.")
    stress = pathlib.Path(folder) / "STRESS.md"
    if stress.exists():
        lines += [""] + stress_lines(stress.read_text())
    return lines + [""]


def page(results, compared, folder):
    """The whole page; `results`: by name, of sheave trade; `compared`: names for the table of both solvers."""
    scenes = [Scene(name, result) for name, result in results.items()]
    machine = next((scene.result for scene in scenes if not scene.fault), None)
    lines = ["# Speed against accuracy", "",
             "Made by `bench/tables/report`, from `sheave trade` on each scene ([method](README.md#speed-against-accuracy))."]
    if machine:
        lines.append(f"Sheave {machine['version']}, {machine['machine']['cpu']}, {machine['machine']['compiler']}; one thread.")
    lines += ["", "Position errors are the largest of all frames, root mean square over the bodies, relative to the scene's size. "
              "Settings: solver, substeps (x iterations), integrator if it is not `xpbd`. ms / s: CPU time per simulated second.", ""]
    lines += advice_lines(scenes) + compared_lines(scenes, compared) + limit_lines(scenes) + other_lines(folder)
    lines += ["## Scenes", "", "Charts show the cost of every setting and its error. The grey line is the Pareto front; dashed lines are 1 %, "
              "0.1 % and 0.01 %. Ladders show the same scene with one effect changed, with one setting. Position and tension are the differences "
              "from the unchanged scene, relative to the size of the scene and to the tensions.", ""]
    for scene in scenes:
        lines += scene_lines(scene)
    return "\n".join(lines).rstrip() + "\n"
