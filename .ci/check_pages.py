#!/usr/bin/env python3
"""Checks numbers in the README, the book and the validation pages against runs of the scenes they come from, as
validation/numbers.toml lists them. A page may not say what the program does not find: one number changed by two in its last
digit fails, which the script tries with each of them. The figures of the pages have to be those that the scenes draw, and links,
chapters and sources what `book.py` asks of them.

    python .ci/check_pages.py RUNS                 RUNS/NAME/summary.json is the run of meshes/NAME.toml
"""
import json
import pathlib
import re
import sys
import tomllib
from decimal import Decimal

import book

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIGURE_FOLDER = ROOT / "validation/figures"
# the figures of the pages, and the files of runs that they are
FIGURES = {
    "bellows": "bellows/pressed",
    "bellows-reaction": "bellows/pressed-reaction",
    "bird-base": "bird-base/folded",
    "column-buckling": "column-buckling/buckled-buckling",
    "coupled-tubes": "coupled-tubes/modes",
    "crane": "crane/folded",
    "crane-fold": "crane-fold/folding",
    "degree-four": "degree-four/folded",
    "drum": "drum-path/crush",
    "drum-buckling": "drum-buckling/crush-reaction",
    "drum-path": "drum-path/crush-reaction",
    "drum-vacuum": "drum-vacuum/folded-reaction",
    "eggbox": "eggbox/relaxed",
    "flat-quad-folded": "flat-quad/folding",
    "flat-quad-strain": "flat-quad/folding-strain",
    "helical-miura": "helical-miura/relaxed",
    "helical-tube": "helical-tube/relaxed",
    "hypar": "hypar/folded",
    "hypar-hexagon": "hypar-hexagon/folded",
    "kirigami-bloch": "kirigami-bloch/modes",
    "kirigami-interface": "kirigami-interface/modes",
    "kirigami-polarized-bloch": "kirigami-polarized-bloch/modes",
    "kresling": "kresling/pressed",
    "kresling-ogden": "kresling-ogden/folded-reaction",
    "kresling-tube": "kresling-tube/relaxed",
    "miura-bend": "miura-bend/bent",
    "miura-bend-reaction": "miura-bend/bent-reaction",
    "miura-flat-folded": "miura-flat-folded/folded",
    "miura-lock": "miura-lock/folded",
    "miura-membrane": "miura-membrane/pressed",
    "thick-miura": "thick-miura/folded",
    "miura-panels": "miura-panels/twisted",
    "miura-pull": "miura-pull/pulled",
    "miura-pull-reaction": "miura-pull/pulled-reaction",
    "miura-response": "miura-response/elastic-ratios",
    "miura-spectrum": "miura-spectrum/spectrum",
    "miura-weight": "miura-weight/hung",
    "miura-yield": "miura-yield/pulled-reaction",
    "near-cross-wells": "near-cross-wells/wells",
    "quad-cell-folded": "quad-cell/roll",
    "quad-cell-strain": "quad-cell/roll-strain",
    "resch": "resch/folded",
    "resch-fold": "resch-fold/folding",
    "resch-folded": "resch-folded/folded",
    "square-twist": "square-twist/folded",
    "star": "star/relaxed",
    "star-strip": "star-strip/modes",
    "star-tube": "star-tube/relaxed",
    "star-bloch": "star-bloch/modes",
    "star-cylinder-bloch": "star-cylinder-bloch/modes",
    "star-landscape": "star-landscape/modes",
    "star-map": "star-map/bending-map",
    "star-surface": "star-surface/surface",
    "star-waves": "star-waves/waves-bands",
    "star-wells": "star-wells/wells",
    "tube": "tube/rolled",
    "two-bars-load": "two-bars-load/loaded-reaction",
    "waterbomb": "waterbomb/relaxed",
    "waterbomb-push": "waterbomb-push/pushed",
    "waterbomb-push-reaction": "waterbomb-push/pushed-reaction",
    "yoshimura": "yoshimura/relaxed",
    "zipper-tubes": "zipper-tubes/modes",
}
PIXEL = 0.25  # of 1,200; places are rounded to 0.1
NUMBER = r"([+-]?\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?)"


def pattern(text):
    """The text with any white space between words, and a number where it has {}."""
    words = [re.escape(word).replace(re.escape("{}"), NUMBER) for word in text.split()]
    return re.compile(r"\s+".join(words))


def found(value, path):
    """The values at a path: a part is a key, a place in a list, the name of an entry of a list, or * for all."""
    for k, part in enumerate(path.split(".")):
        if part == "*":
            rest = path.split(".")[k + 1 :]
            return [one for entry in value for one in found(entry, ".".join(rest))] if rest else list(value)
        if isinstance(value, list) and not part.isdigit():
            value = next(entry for entry in value if entry["name"] == part)
        else:
            value = value[int(part) if isinstance(value, list) else part]
    return [value]


def summed(summary, path):
    """The values at a path, or the sum of those at several."""
    terms = [found(summary, one.strip()) for one in path.split(" + ")]
    return terms[0] if len(terms) == 1 else [sum(value for term in terms for value in term)]


def agrees(shown, value, kind):
    """Whether a page may show a value so: rounded to the digits shown (its size alone, where that is the kind), or bounded by it
    within a factor of ten."""
    if value is None:
        return False
    value, number = abs(value) if kind == "size" else value, Decimal(shown.replace(",", ""))
    if kind == "bound":
        return 0 <= abs(value) <= float(number) <= 10 * abs(value)
    unit = Decimal((0, (1,), number.as_tuple().exponent))
    return abs(Decimal(value) - number) <= Decimal("0.501") * unit


def changed(shown):
    """The same with its last digit off by two units."""
    number = Decimal(shown.replace(",", ""))
    unit = Decimal((0, (1,), number.as_tuple().exponent))
    return str(number + 2 * unit), str(number - 2 * unit)


def faults(entry, runs):
    """What is wrong with one entry of the list."""
    page = (ROOT / entry["page"]).read_text()
    places = list(pattern(entry["text"]).finditer(page))
    if len(places) != 1:
        return [f"the page has this text {len(places)} times, not once"]
    summary = json.loads((runs / entry["scene"] / "summary.json").read_text())
    values = [value for path in entry["values"] for value in summed(summary, path)]
    shown, kind = places[0].groups(), entry.get("kind", "rounded")
    if len(shown) != len(values):
        return [f"{len(shown)} numbers are shown, {len(values)} were found: {values}"]
    wrong = [f"the page says {s}, the run {v!r}" for s, v in zip(shown, values) if not agrees(s, v, kind)]
    if kind != "bound":
        pairs = [(s, v) for s, v in zip(shown, values) if agrees(s, v, kind)]
        wrong += [f"{other} for {s} is not refused" for s, v in pairs for other in changed(s) if agrees(other, v, kind)]
    return wrong


def other_figures(runs):
    """The figures that are not what the runs draw, and those of which no run is known."""
    numeral, colour = re.compile(r"-?\d+\.?\d*"), re.compile("#[0-9a-f]{6}")
    wrong = [f"{file.name}: no run is known" for file in FIGURE_FOLDER.glob("*.svg") if file.stem not in FIGURES]
    for name, run in FIGURES.items():
        files = FIGURE_FOLDER / f"{name}.svg", runs / f"{run}.svg"
        kept, drawn = (colour.sub("#", file.read_text()) for file in files)
        same_words = numeral.sub("", kept) == numeral.sub("", drawn)
        pairs = zip(numeral.findall(kept), numeral.findall(drawn))
        if not same_words or any(abs(float(a) - float(b)) > PIXEL for a, b in pairs if a != b):
            wrong.append(f"{name}.svg is not what {run}.svg is")
    return wrong


def main():
    runs = pathlib.Path(sys.argv[1])
    entries = tomllib.loads((ROOT / "validation/numbers.toml").read_text())["number"]
    failed = 0
    for entry in entries:
        for fault in faults(entry, runs):
            failed += 1
            print(f"FAILED {entry['page']}: \"{entry['text']}\" ({entry['scene']}): {fault}")
    for fault in other_figures(runs) + book.faults(ROOT):
        failed += 1
        print(f"FAILED {fault}")
    print(f"{len(entries)} texts and {len(FIGURES)} figures of {len(book.pages(ROOT))} pages, {failed} failures")
    sys.exit(failed > 0 or not entries)


if __name__ == "__main__":
    main()
