"""The gallery's pages of layouts and fusion methods, from a small run of the paper's study."""

import html
import json

import curves

REPETITIONS = 300
REGIMES = {"mass": "all nodes move", "partial_proximal": "only a part moves, from the motor"}
ERRORS = ("SELECT e.regime, e.family, e.sensor_count, e.method, e.mean_abs_error_N, e.method_title FROM v_error_by_layout e "
          "ORDER BY e.sensor_count")
LAYOUTS = "SELECT l.family, l.start, l.sensor_count, l.label, s.nodes FROM layout l JOIN sensor_set s USING (sensor_set_id)"


def write(book):
    catalogue = json.loads(book.capstan("config", "catalogue", "--json"))
    folder = book.runs / "layouts"
    folder.mkdir(parents=True)
    book.capstan("study", "run", book.surroundings.source / "configs/paper.toml", "--db", "layouts.db", "--repetitions", REPETITIONS,
                 "--progress", "none", "-o", "advice.txt", cwd=folder)
    errors = json.loads(book.capstan("query", ERRORS, "--db", "layouts.db", "--json", cwd=folder))
    layouts = json.loads(book.capstan("query", LAYOUTS, "--db", "layouts.db", "--json", cwd=folder))
    for family in catalogue["layouts"]:
        book.write(f"gallery/layout-{family['name']}.md", layout_page(family, catalogue, layouts, errors))
    for method in catalogue["fusion_methods"]:
        book.write(f"gallery/method-{method['name'].replace('_', '-')}.md", method_page(method, catalogue, errors))
    book.write("gallery/layouts.md", index("Layouts", "A layout says which nodes carry sensors.", catalogue["layouts"], "layout"))
    book.write("gallery/methods.md", index(
        "Fusion methods", "A fusion method turns the readings of several sensors into the tension at every node.",
        catalogue["fusion_methods"], "method"))


def best_of(errors, regime, family=None, method=None):
    """(sensor counts, the smallest error of each) over what is left open. A method that is told the direction has an advantage."""
    best = {}
    for row in errors:
        fits = row["regime"] == regime and (family is None or row["family"] == family) and (method is None or row["method"] == method)
        if fits and (method is not None or row["method"] != "mean_known"):
            count = row["sensor_count"]
            best[count] = min(best.get(count, float("inf")), row["mean_abs_error_N"])
    return list(best), list(best.values())


def drawn_layouts(rows, nodes=11):
    """Each count as a line of nodes with its sensors."""
    rows = sorted((row for row in rows if row["sensor_count"] <= 5), key=lambda row: (row["sensor_count"], row["start"]))
    step, left, height = 34, 232, 22
    parts = []
    for k, row in enumerate(rows):
        y = 16 + k * height
        parts.append(f'<text x="0" y="{y + 4}">{html.escape(row["label"])}</text>')
        parts.append(f'<line x1="{left}" y1="{y}" x2="{left + (nodes - 1) * step}" y2="{y}" stroke="currentColor" opacity="0.4"/>')
        carried = set(json.loads(row["nodes"]))
        for node in range(1, nodes + 1):
            x = left + (node - 1) * step
            parts.append(f'<circle class="fill-effect" cx="{x}" cy="{y}" r="6"/>' if node in carried else
                         f'<circle cx="{x}" cy="{y}" r="2.5" fill="currentColor" opacity="0.5"/>')
    bottom = 16 + len(rows) * height
    parts.append(f'<text x="{left - 6}" y="{bottom + 8}">motor</text>'
                 f'<text x="{left + (nodes - 1) * step}" y="{bottom + 8}" text-anchor="end">load</text>')
    return ('```{raw} html\n<figure class="drawn" style="max-width: 44rem">'
            f'<svg viewBox="0 0 {left + (nodes - 1) * step + 12} {bottom + 16}" font-size="10.5" fill="currentColor" role="img" '
            'aria-label="nodes with sensors">' + "".join(parts) + "</svg></figure>\n```\n")


def layout_page(family, catalogue, layouts, errors):
    text = (f"# {family['title']}\n\nSensors {family['meaning']}. In a configuration: `families = [\"{family['name']}\"]`.\n\n"
            "Dots are the eleven nodes of the paper's cable, from the motor to the load; full circles carry a sensor.\n\n")
    text += drawn_layouts([row for row in layouts if row["family"] == family["name"]])
    figures = []
    for regime, words in REGIMES.items():
        drawn = [("effect", family["title"], *best_of(errors, regime, family["name"]))]
        others = [each for each in catalogue["layouts"] if each["name"] != family["name"]]
        drawn += [(style, other["title"], *best_of(errors, regime, other["name"])) for style, other in zip(("rival", "third"), others)]
        figures.append(curves.figure(drawn, "number of sensors", "mean error [N]", f"Motion regime {regime}: {words}.", shape="dots"))
    return text + ("\n## How it compares\n\nThe paper's cable with 10% sensor noise. Each point has the best fusion method that is not told the "
                   "direction of motion.\n\n" + curves.row(figures) + "\n" + comparison_in_words(
                       {each["title"]: {regime: best_of(errors, regime, each["name"]) for regime in REGIMES} for each in catalogue["layouts"]}))


def method_page(method, catalogue, errors):
    text = f"# {method['title']}\n\n{method['meaning'][0].upper() + method['meaning'][1:]}. Source: {method['source']}.\n\n"
    text += {"direction_known": "It is told the true direction of every segment, so it is a reference and never recommended.",
             "direction_unknown": "It is not told the direction of motion; the single-sensor estimates vote on it "
                                  "([single sensors and votes](../theory/estimators.md)).",
             "feasible_curve": "It is not told the direction of motion; it weighs the states on the feasible curve "
                               "([feasible curve](../theory/estimators.md)).", }[method["knowledge"]] + "\n\n"
    text += f"In a configuration: `methods = [\"{method['name']}\"]`.\n\n## How it compares\n\n"
    figures = []
    for regime, words in REGIMES.items():
        drawn = [("effect", method["title"], *best_of(errors, regime, method=method["name"])),
                 ("rival", "the best of all methods", *best_of(errors, regime))]
        figures.append(curves.figure(drawn, "number of sensors", "mean error [N]", f"Motion regime {regime}: {words}.", shape="dots"))
    return text + ("The paper's cable with 10% sensor noise; each point has the best layout of that number of sensors.\n\n"
                   + curves.row(figures) + "\n" + comparison_in_words(
                       {each["title"]: {regime: best_of(errors, regime, method=each["name"]) for regime in REGIMES}
                        for each in catalogue["fusion_methods"]}))


def comparison_in_words(found):
    """Rows: titles; columns: regimes with three sensors."""
    text = "| with 3 sensors | " + " | ".join(f"{regime} [N]" for regime in REGIMES) + " |\n| --- |" + " --- |" * len(REGIMES) + "\n"
    for title, regimes in found.items():
        values = [dict(zip(*regimes[regime]))[3] for regime in REGIMES]
        text += f"| {title} | " + " | ".join(f"{value:.3f}" for value in values) + " |\n"
    return text


def index(title, words, rows, kind):
    text = f"# {title}\n\n{words}\n\n| name | meaning |\n| --- | --- |\n"
    names = [f"{kind}-{row['name'].replace('_', '-')}" for row in rows]
    for name, row in zip(names, rows):
        text += f"| [{row['title']}]({name}.md) | {row['meaning']} |\n"
    return text + "\n```{toctree}\n:hidden:\n\n" + "\n".join(names) + "\n```\n"
