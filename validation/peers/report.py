"""The tables, in Markdown."""

import os
import platform


def number(value, digits=2):
    return "" if value is None else f"{value:.{digits}g}"


def seconds(step):
    for factor, unit in ((1.0, "s"), (1e3, "ms"), (1e6, "µs"), (1e9, "ns")):
        if step * factor >= 1.0:
            break
    return f"{step * factor:.3g} {unit}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def row_of(run, swings):
    about = "about " if run.get("extrapolated") else ""
    last = number(run.get("kept"), 3) if swings else about * ("to_rest" in run) + number(run.get("to_rest"))
    return (
        run["engine"],
        run["method"],
        str(run["elements"]),
        run["ends"],
        seconds(run["step"]) if run["step"] else "static",
        about * ("cost" in run) + number(run.get("cost")),
        number(run.get("error")),
        last,
        run.get("note", ""),
    )


def full(case, runs):
    swings = case.rests_at is None
    head = ("engine", "method", "elements", "ends", "step", "CPU s per simulated s", "error", "swing kept" if swings else "CPU s to rest", "")
    return table(head, [row_of(run, swings) for run in runs])


def best(case, runs, errors=(0.05, 0.01, 0.001)):
    """The least that each engine asks for an answer of a given error, whatever its step, its method and its number of elements."""
    swings = case.rests_at is None
    measure = "cost" if swings else "to_rest"
    what = "CPU s per simulated s" if swings else "CPU s to rest"
    rows = []
    for engine in dict.fromkeys(run["engine"] for run in runs):
        cells = [engine]
        for error in errors:
            good = [run for run in runs if run["engine"] == engine and run.get("error", 1.0) <= error and measure in run]
            if not good:
                cells.append("")
                continue
            run = min(good, key=lambda run: run[measure])
            step = seconds(run["step"]) if run["step"] else "static"
            cells.append(f"{number(run[measure])} ({run['method']}, {step}, {run['elements']} elements)")
        rows.append(cells)
    return table(("engine", *(f"{what}, error at most {error:g}" for error in errors)), rows)


def machine():
    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo") as file:
            model = next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), model)
    except OSError:
        pass
    return f"{model}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}, Python {platform.python_version()}, one thread"
