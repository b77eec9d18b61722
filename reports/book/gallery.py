"""The gallery: a page for each effect of the catalogue, from simulations with and without it."""

import json
import math

import numpy as np

import curves
from bench_of_gallery import EXPERIMENTS, FIRST, OUTPUTS, Bench, section_of

AXES = {"motor_torque": ("motor torque [N m]", 1.0), "load_torque": ("load torque [N m]", 1.0),
        "load_angle": ("load angle [deg]", 180.0 / math.pi), "motor_angle": ("motor angle [deg]", 180.0 / math.pi)}
NOISE = 0.01  # of a channel's span without the effect: what a residual is measured in


class Residuals:
    """What each cause adds to each channel, in units of noise, stacked over the channels of an experiment."""

    def __init__(self, bench, effects):
        self.bench = bench
        self.results = results = bench.all(effects)
        spans = {}
        for channel in OUTPUTS:
            spans[channel] = max(np.ptp(causes[""][channel]) for causes in results.values())
        self.unit = {channel: NOISE * span for channel, span in spans.items()}

    def of(self, cause, experiment):
        causes = self.results[experiment]
        return np.concatenate([(causes[cause][c] - causes[""][c]) / self.unit[c] for c in OUTPUTS]) / math.sqrt(
            causes[""][OUTPUTS[0]].size)


def fitted(effect, rival, either_sign):
    """The size at which the rival's residual comes nearest, and the cosine there."""
    size = float(effect @ rival) / max(float(rival @ rival), 1e-30)
    size = size if either_sign else max(size, 0.0)
    norm = np.linalg.norm(effect) * np.linalg.norm(rival)
    return size, (abs(float(effect @ rival)) / norm if size != 0.0 and norm > 0.0 else 0.0)


class Comparison:
    """An effect beside everything that it could be confused with, in the first experiment that shows it."""

    def __init__(self, effect, causes, residuals):
        self.effect = effect
        self.residuals = residuals
        strength = {e: float(np.linalg.norm(residuals.of(effect["section"], e))) for e in EXPERIMENTS}
        self.shown = next(e for e in EXPERIMENTS if strength[e] > 0.3 * max(strength.values()))
        mine = residuals.of(effect["section"], self.shown)
        self.rivals = []  # (cosine, size, cause), the most similar first
        for cause in causes:
            if cause["name"] == effect["name"] or cause["key"] == effect["section"]:
                continue
            size, cosine = fitted(mine, residuals.of(cause["key"], self.shown), cause["either_sign"])
            self.rivals.append((cosine, size, cause))
        self.rivals.sort(key=lambda each: -each[0])

    def left(self, experiment, rival):
        """What the rival, sized by both recordings together, cannot reproduce of them: in noise, and the cosine."""
        mine = np.concatenate([self.residuals.of(self.effect["section"], e) for e in (self.shown, experiment)])
        other = np.concatenate([self.residuals.of(rival["key"], e) for e in (self.shown, experiment)])
        size, cosine = fitted(mine, other, rival["either_sign"])
        return float(np.linalg.norm(mine - size * other)), cosine

    def best_experiment(self, rival):
        """The least similarity among those where the rival leaves at least half of what it can leave."""
        left = {e: self.left(e, rival) for e in EXPERIMENTS if e != self.shown}
        enough = [e for e in left if left[e][0] >= 0.5 * max(each for each, _ in left.values())]
        return min(enough, key=lambda e: left[e][1])


def write(book):
    catalogue = json.loads(book.capstan("config", "catalogue", "--json"))
    effects = catalogue["effects"]
    residuals = Residuals(Bench(book.build / "capstan", book.runs / "gallery"), effects)
    causes = [{"name": e["name"], "key": e["section"], "effect": e, "title": full_title(e),
               "either_sign": any(p["low"] < 0 for p in e["parameters"])} for e in effects]
    causes += [{"name": c["name"], "key": c["name"], "effect": None, "title": c["title"], "either_sign": True}
               for c in catalogue["other_causes"] if c["name"].startswith("param_")]
    titles = {each["name"]: each["title"] for each in effects + catalogue["other_causes"]}
    names = list(dict.fromkeys(effect["name"] for effect in effects))
    for name in names:
        variants = [effect for effect in effects if effect["name"] == name]
        book.write(f"gallery/{name}.md", page(variants, causes, residuals, titles, names))
    book.write("gallery/effects.md", index(effects, names))


def full_title(effect):
    return effect["title"] + (f", {effect['variant']}" if effect["variant"] else "")


def page(variants, causes, residuals, titles, names):
    first = variants[0]
    text = f"# {first['title'][0].upper() + first['title'][1:]}\n\n"
    text += (f"**{first['meaning'][0].upper() + first['meaning'][1:]}** ([{first['equation']}]({first['equation'].lower()}))."
             f" Family: {first['family']}.")
    text += " It shows only on a pull-pull pair.\n\n" if first["needs_pair"] else "\n\n"
    for effect in variants:
        text += one_variant(effect, causes, residuals)
    text += confusions(first, titles, names)
    return text


def one_variant(effect, causes, residuals):
    text = f"## {effect['variant'][0].upper() + effect['variant'][1:]}\n\n" if effect["variant"] else "## The loop that it makes\n\n"
    if effect["variant"]:
        text += effect["meaning"][0].upper() + effect["meaning"][1:] + ".\n\n"
    comparison = Comparison(effect, causes, residuals)
    cosine, size, rival = comparison.rivals[0]
    separating = comparison.best_experiment(rival)
    text += curves.row([loop(effect, comparison.shown, residuals),
                        loop(effect, separating, residuals, rival, size, comparison.shown)]) + "\n"
    size = "" if effect["factor"] == 1.0 else f", {effect['factor']:g} times as large as in a mild case to make it visible"
    text += f"The effect as drawn{size}:\n\n```toml" + section_of(effect, effect["factor"]) + "```\n\n"
    text += "| cause | similarity of its residuals |\n| --- | --- |\n"
    for similarity, _, other in comparison.rivals[:4]:
        text += f"| {other['title']} | {similarity:.2f} |\n"
    text += ("\nSimilarity is the cosine between what the two causes add to the motor torque, the load torque and the load angle "
             f"in *{comparison.shown}*; with 1, one reproduces the other if its size is chosen freely.\n\n")
    left, joint = comparison.left(separating, rival)
    further = len(EXPERIMENTS) - 1
    return text + (f"**The experiment that separates them.** Of {further} further recordings, *{separating}* separates {full_title(effect)} "
                   f"best from {rival['title']}. Together with {comparison.shown} the similarity is {joint:.2f}, where it was {cosine:.2f}. "
                   f"To first order in its size, {rival['title']} then leaves residuals of at least {left:.2g} times the noise of sensors with 1% noise (RMS).\n\n")


def loop(effect, experiment, residuals, rival=None, size=0.0, fitted_to=""):
    results, key = residuals.results[experiment], effect["section"]
    compared = [(results[""], results[key])] if rival is None else [(results[key], results[rival["key"]])]
    across = "motor_angle" if np.ptp(results[""]["motor_angle"]) > 1e-6 else "load_angle"
    channel = max((c for c in OUTPUTS if c != across), key=lambda c: max(np.std(a[c] - b[c]) / residuals.unit[c] for a, b in compared))
    title, unit = AXES[channel]
    x_title, x_unit = AXES[across]
    steady = slice(results[""]["t"].size // 4, None) if experiment == FIRST else slice(None)
    x = (results[""][across] * x_unit)[steady]
    drawn = [("ideal", "without it", x, (results[""][channel] * unit)[steady]),
             ("effect", full_title(effect), (results[key][across] * x_unit)[steady], (results[key][channel] * unit)[steady])]
    caption = f"{experiment[0].upper() + experiment[1:]}."
    if rival is not None:
        other = residuals.bench.resized(experiment, rival["key"], rival["effect"], size)
        drawn.append(("rival", rival["title"], (other[across] * x_unit)[steady], (other[channel] * unit)[steady]))
        caption += f" {rival['title'][0].upper() + rival['title'][1:]} has the size that fits best in {fitted_to}."
    return curves.figure(drawn, x_title, title, caption)


def confusions(effect, titles, names):
    text = "## What a diagnosis confuses it with\n\n"
    others = effect["confusable_with"]
    if not others:
        return text + ("The catalogue states no cause whose residuals are nearly the same (a cosine of 0.95 and more) over all "
                       "motions of a bench.\n")
    listed = [f"[{titles[name]}]({name}.md)" if name in names else titles[name] for name in others]
    return text + ("The catalogue states that its residuals are nearly the same (a cosine of 0.95 and more over all motions) as those of "
                   + " and ".join([", ".join(listed[:-1])] * (len(listed) > 1) + listed[-1:]) + ". A diagnosis that finds one of them "
                   "reports the group and names the experiment that would decide.\n")


def index(effects, names):
    text = ("# Effects\n\nWhat a bench does that the ideal model leaves out. Each page shows the loop of the effect at a stated size, the "
            "causes that resemble it, and the recording that separates it from the most similar one. The bench is the same on all pages: two "
            "cables between pulleys of 20 mm, 1.2 m long with one bend of 165\N{DEGREE SIGN}, a friction coefficient of 0.12 and a pretension of "
            "20 N. The program simulates every page anew.\n\n| effect | family | equation | meaning |\n| --- | --- | --- | --- |\n")
    for name in names:
        effect = next(each for each in effects if each["name"] == name)
        text += (f"| [{effect['title']}]({name}.md) | {effect['family']} | [{effect['equation']}]({effect['equation'].lower()}) | "
                 f"{effect['meaning']} |\n")
    return text + "\n```{toctree}\n:hidden:\n\n" + "\n".join(names) + "\n```\n"
